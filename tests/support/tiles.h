#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "geometry/geometry_method.h"

namespace bspc::test {

/// A tile of at least one point, which must outlive it, in its tight box.
inline geometry::TileInput tileOf(const std::vector<GridPoint>& points, unsigned layers) {
  geometry::TileInput tile;
  tile.points = points;
  tile.layers = layers;
  GridPoint upper = points[0];
  tile.lower = points[0];
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      tile.lower[k] = std::min(tile.lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = upper[k] - tile.lower[k];
  return tile;
}

}  // namespace bspc::test
