#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace bspc::geometry {

/// Makes room in `cells` for `more` of them, after telling `points.cellsInMemory()` what there will
/// be with `others`, the bytes of all other cells. It may throw, as may `points.working()`, which
/// is called each time.
template <class Points, class Cell>
void makeRoom(Points& points, std::vector<Cell>& cells, std::size_t more, std::uint64_t others) {
  points.working();
  if (cells.capacity() - cells.size() >= more) return;
  constexpr std::size_t kFirst = 64;
  const std::size_t capacity = std::max({2 * cells.capacity(), cells.size() + more, kFirst});
  // While they are moved, the old and the new array stand side by side.
  points.cellsInMemory(others + (cells.capacity() + capacity) * sizeof(Cell));
  cells.reserve(capacity);
}

/// Bytes of an array of cells, without what they point to.
template <class Cell>
std::uint64_t bytesOf(const std::vector<Cell>& cells) {
  return std::uint64_t{cells.capacity()} * sizeof(Cell);
}

}  // namespace bspc::geometry
