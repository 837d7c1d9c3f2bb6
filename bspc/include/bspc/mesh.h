#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/span.h"

namespace bspc {

/// Lists of points by their numbers, one list after the other: list i has the points
/// indices[ends[i − 1]] … indices[ends[i] − 1], the first one from 0 on. At most 2^32 − 16 points
/// can have numbers, and as many can be listed.
struct Cells {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> ends;

  std::size_t size() const { return ends.size(); }
  bool empty() const { return ends.empty(); }
  std::uint32_t first(std::size_t i) const { return i == 0 ? 0 : ends[i - 1]; }
  Span<const std::uint32_t> operator[](std::size_t i) const {
    return {indices.data() + first(i), ends[i] - std::size_t{first(i)}};
  }
  void add(Span<const std::uint32_t> cell) {
    indices.insert(indices.end(), cell.begin(), cell.end());
    ends.push_back(static_cast<std::uint32_t>(indices.size()));
  }
};

/// What a mesh has beside its points. All three sorts may have any number of points, which may
/// repeat. Where cells are counted through, vertex cells come first, then lines, then faces.
struct MeshCells {
  Cells vertices;
  Cells lines;  ///< polylines
  Cells faces;  ///< polygons; their sense is kept

  std::size_t size() const { return vertices.size() + lines.size() + faces.size(); }
  bool empty() const { return size() == 0; }
};

}  // namespace bspc
