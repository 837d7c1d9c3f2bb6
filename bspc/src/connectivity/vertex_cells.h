#pragma once

#include <cstdint>

#include "bspc/error.h"
#include "bspc/mesh.h"
#include "connectivity/numbers.h"

namespace bspc::connectivity {

/// Codes vertex cells by the steps from each point's number to the next.
template <class Coder>
class VertexCells {
 public:
  VertexCells(Coder& coder, std::uint64_t points) : coder_(coder), points_(points) {}

  /// `check()` may throw to stop.
  template <class Check>
  void code(std::uint64_t count, Cells& cells, Check check) {
    const bool oneEach = coder_.raw(isOneEach(count, cells) ? 1 : 0, 1) != 0;
    if (oneEach) {
      if (count != points_) throw Error(ErrorCode::Corrupt, "vertex cells are not one a point");
      if (!Coder::kWriting) appendOneEach(cells, check);
      return;
    }
    std::int64_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % kCheckEvery == 0) check();
      const std::uint64_t size =
          size_.code(coder_, Coder::kWriting ? cells[static_cast<std::size_t>(i)].size() : 0);
      cell_.clear();
      for (std::uint64_t j = 0; j < size; ++j) {
        const std::int64_t given =
            Coder::kWriting ? cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] : 0;
        const auto number = static_cast<std::uint64_t>(next) +
                            static_cast<std::uint64_t>(step_.codeSigned(coder_, given - next));
        if (number >= points_) throw Error(ErrorCode::Corrupt, "a vertex cell has a wrong point");
        next = static_cast<std::int64_t>(number) + 1;
        if (Coder::kWriting) continue;
        cell_.push_back(static_cast<std::uint32_t>(number));
        if (cell_.size() % kCheckEvery == 0) check();
      }
      if (!Coder::kWriting) cells.add(cell_);
    }
  }

 private:
  static constexpr std::uint64_t kCheckEvery = 1024;

  bool isOneEach(std::uint64_t count, const Cells& cells) const {
    if (!Coder::kWriting || count != points_ || cells.indices.size() != points_) return false;
    for (std::uint32_t i = 0; i < points_; ++i) {
      if (cells.ends[i] != i + 1 || cells.indices[i] != i) return false;
    }
    return true;
  }

  template <class Check>
  void appendOneEach(Cells& cells, Check check) const {
    for (std::uint32_t i = 0; i < points_; ++i) {
      if (i % kCheckEvery == 0) check();
      cells.indices.push_back(i);
      cells.ends.push_back(i + 1);
    }
  }

  Coder& coder_;
  std::uint64_t points_;
  AdaptiveNumber size_;
  AdaptiveNumber step_;
  std::vector<std::uint32_t> cell_;
};

}  // namespace bspc::connectivity
