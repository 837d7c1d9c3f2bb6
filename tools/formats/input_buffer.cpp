#include "formats/input_buffer.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "bspc/error.h"
#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

/// Bytes from here to the end of the stream; 0 for a pipe.
std::uint64_t bytesToEnd(std::istream& in) {
  std::uint64_t bytes = 0;
  const std::istream::pos_type here = in.tellg();
  if (here != std::istream::pos_type(-1)) {
    in.seekg(0, std::ios::end);
    const std::istream::pos_type end = in.tellg();
    in.clear();
    in.seekg(here);
    if (in && end > here) bytes = static_cast<std::uint64_t>(end - here);
  }
  in.clear();
  return bytes;
}

}  // namespace

InputBuffer::InputBuffer(std::istream& in, ProgressCallback progress)
    : in_(in), progress_(std::move(progress)), buffer_(kBlock) {
  if (!in) throw FormatError("cannot be read: the input stream has failed");
  streamBytes_ = bytesToEnd(in);
  start_ = in.tellg();
  canSeek_ = start_ != std::istream::pos_type(-1);
  in.clear();
}

void InputBuffer::seek(std::uint64_t offset) {
  in_.clear();
  in_.seekg(start_ + static_cast<std::istream::off_type>(offset));
  if (!canSeek_ || !in_) throw FormatError("cannot be read: the input stream cannot go back");
  begin_ = end_ = 0;
  offset_ = offset;
}

std::size_t InputBuffer::readStream(char* to, std::size_t count) {
  if (!in_) return 0;
  report();
  in_.read(to, static_cast<std::streamsize>(count));
  if (in_.bad()) {
    throw FormatError("cannot be read: the input stream has failed after byte " +
                      grouped(offset_ + available()));
  }
  return static_cast<std::size_t>(in_.gcount());
}

void InputBuffer::report() {
  if (!progress_) return;
  const auto done = static_cast<double>(offset_);
  const auto all = static_cast<double>(std::max(streamBytes_, offset_));
  if (!progress_(all > 0 && streamBytes_ > 0 ? done / all : 0)) {
    throw Error(ErrorCode::Cancelled, "stopped as asked");
  }
}

bool InputBuffer::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), data(), available());
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t got = readStream(buffer_.data() + end_, buffer_.size() - end_);
  end_ += got;
  return got > 0;
}

std::size_t InputBuffer::read(std::uint8_t* to, std::size_t count) {
  const std::size_t buffered = std::min(count, available());
  if (buffered > 0) std::memcpy(to, data(), buffered);
  consume(buffered);
  if (buffered == count) return count;
  const std::size_t got = readStream(reinterpret_cast<char*>(to) + buffered, count - buffered);
  offset_ += got;
  return buffered + got;
}

std::uint64_t InputBuffer::skip(std::uint64_t count) {
  std::uint64_t left = count;
  while (left > 0) {
    if (available() == 0 && !fill()) break;
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(left, available()));
    consume(step);
    left -= step;
  }
  return count - left;
}

std::size_t InputBuffer::reservable(std::uint64_t claimed, std::size_t bytes) const {
  const std::uint64_t left = streamBytes_ > offset_ ? streamBytes_ - offset_ : 0;
  return static_cast<std::size_t>(std::min<std::uint64_t>(claimed, left / bytes));
}

}  // namespace bspc::formats
