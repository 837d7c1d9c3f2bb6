#include "process_group.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

#include <algorithm>
#include <new>
#include <numeric>

#include "bspc/error.h"

namespace bspc::vtk {

namespace {

/// An error as a message: its code, then its text; empty if there was none.
Bytes messageOf(ErrorCode code, const std::string& text) {
  Bytes message(1 + text.size());
  message[0] = static_cast<std::uint8_t>(code);
  std::copy(text.begin(), text.end(), message.begin() + 1);
  return message;
}

Bytes runAndTell(const std::function<void()>& own) {
  try {
    own();
  } catch (const Error& error) {
    return messageOf(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return messageOf(ErrorCode::LimitExceeded, "there is not enough memory for the points");
  }
  return {};
}

}  // namespace

std::size_t ProcessGroup::rank() const {
  return static_cast<std::size_t>(controller_.GetLocalProcessId());
}

std::size_t ProcessGroup::size() const {
  return static_cast<std::size_t>(controller_.GetNumberOfProcesses());
}

void ProcessGroup::step(const std::function<void()>& own) {
  const std::vector<Bytes> messages = gatherEverywhere(runAndTell(own));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (messages[i].empty()) continue;
    const std::string text(messages[i].begin() + 1, messages[i].end());
    const std::string where = i == rank() ? "" : "process " + std::to_string(i) + ": ";
    throw Error(static_cast<ErrorCode>(messages[i][0]), where + text);
  }
}

std::vector<Bytes> ProcessGroup::gatherEverywhere(const Bytes& own) {
  const auto length = static_cast<vtkIdType>(own.size());
  std::vector<vtkIdType> lengths(size());
  controller_.AllGather(&length, lengths.data(), 1);
  std::vector<vtkIdType> offsets(size());
  std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
  Bytes together(static_cast<std::size_t>(offsets.back() + lengths.back()) + 1);
  // One more byte here and there, so that no buffer is at a null address.
  Bytes sent = own;
  sent.push_back(0);
  controller_.AllGatherV(sent.data(), together.data(), length, lengths.data(), offsets.data());
  std::vector<Bytes> all;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto begin = together.begin() + offsets[i];
    all.emplace_back(begin, begin + lengths[i]);
  }
  return all;
}

std::uint64_t ProcessGroup::sum(std::uint64_t own) {
  const auto value = static_cast<vtkIdType>(own);
  vtkIdType total = 0;
  controller_.AllReduce(&value, &total, 1, vtkCommunicator::SUM_OP);
  return static_cast<std::uint64_t>(total);
}

double ProcessGroup::greatest(double own) {
  double value = 0;
  controller_.AllReduce(&own, &value, 1, vtkCommunicator::MAX_OP);
  return value;
}

bool ProcessGroup::all(bool own) {
  const int value = own ? 1 : 0;
  int least = 0;
  controller_.AllReduce(&value, &least, 1, vtkCommunicator::MIN_OP);
  return least != 0;
}

}  // namespace bspc::vtk
