#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "bspc/mesh.h"
#include "connectivity/numbers.h"
#include "connectivity/vertex_picker.h"

namespace bspc::connectivity {

/// Codes lists of vertices one after the other, in their order, each vertex from those before it:
/// lines, and the faces that are no part of an oriented surface. Vertices may repeat.
template <class Coder>
class PlainCells {
 public:
  enum class Shape { Line, Face };

  PlainCells(Coder& coder, Span<const Position> positions, const VertexIndex& index, Shape shape)
      : coder_(coder),
        positions_(positions),
        shape_(shape),
        first_(index, positions.size()),
        second_(index, positions.size()),
        other_(index, positions.size()) {}

  /// Codes `count` cells; a decoder appends them to `cells`. `check()` may throw to stop.
  template <class Check>
  void code(std::uint64_t count, Cells& cells, Check check) {
    for (std::uint64_t i = 0; i < count; ++i) {
      cell_.clear();
      const Span<const std::uint32_t> given =
          Coder::kWriting ? cells[static_cast<std::size_t>(i)] : Span<const std::uint32_t>();
      const std::uint64_t size = size_.code(coder_, given.size());
      for (std::uint64_t j = 0; j < size; ++j) {
        if (positions_.empty()) throw Error(ErrorCode::Corrupt, "a cell without vertices to have");
        codeVertex(Coder::kWriting ? given[static_cast<std::size_t>(j)] : 0);
        if (cell_.size() % kCheckEvery == 0) check();
      }
      if (!cell_.empty()) previous_ = cell_.back();
      if (!Coder::kWriting) cells.add(cell_);
      if (i % kCheckEvery == 0) check();
    }
  }

  const std::vector<std::uint32_t>& current() const { return cell_; }

 private:
  static constexpr std::size_t kCheckEvery = 256;

  void codeVertex(std::uint32_t value) {
    if (cell_.empty()) {
      // Most lines, and most faces that are left over, begin where the last one was.
      cell_.push_back(first_.code(coder_, doubled(previous_), value));
    } else if (cell_.size() == 1) {
      cell_.push_back(second_.code(coder_, doubled(cell_[0]), value));
    } else {
      cell_.push_back(other_.code(coder_, expected(), value));
    }
  }

  Position doubled(std::uint32_t vertex) const {
    Position place = positions_[vertex];
    for (double& x : place) x *= 2;
    return place;
  }

  Position expected() const {
    const Position& a = positions_[cell_[cell_.size() - 2]];
    const Position& b = positions_[cell_.back()];
    Position place{};
    for (std::size_t k = 0; k < 3; ++k) {
      // A line goes straight on; a face turns back to its first vertex.
      place[k] = shape_ == Shape::Line ? 2 * (2 * b[k] - a[k]) : b[k] + positions_[cell_[0]][k];
    }
    return place;
  }

  Coder& coder_;
  Span<const Position> positions_;
  Shape shape_;
  VertexPicker first_;
  VertexPicker second_;
  VertexPicker other_;
  AdaptiveNumber size_;
  std::vector<std::uint32_t> cell_;
  std::uint32_t previous_ = 0;
};

}  // namespace bspc::connectivity
