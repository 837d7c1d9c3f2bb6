#pragma once

#include <cstdint>
#include <vector>

#include "geometry/bsp/polyhedron.h"

namespace bspc::geometry {

/// A cell of method bsp and what is known of its points.
struct BspCell {
  std::vector<std::uint8_t> shape;  ///< packed polyhedron; empty: the cell is its grid box
  GridBox box;                      ///< where its points can be
  unsigned history = 0;             ///< see BspCountModel
  std::uint64_t count = 0;
  std::uint64_t first = 0;  ///< number of points in the leaves before it
  std::uint64_t id = 0;     ///< of its ancestor in the layer that cell ids are asked of

  bool boxOnly() const { return shape.empty(); }
  /// Of the shape, beside the cell itself.
  std::uint64_t bytes() const { return shape.capacity(); }
};

}  // namespace bspc::geometry
