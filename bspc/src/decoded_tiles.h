#pragma once

#include <cstdint>

#include "bspc/decoder.h"
#include "bspc/limits.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// Gathers decoded tiles into the points of the file, within the limits.
class DecodedTiles {
 public:
  DecodedTiles(const DecodeLimits& limits, bool counts, bool cellIds)
      : limits_(limits),
        bytesPerPoint_(sizeof(GridPoint) + (counts ? 8U : 0U) + (cellIds ? 8U : 0U)) {}

  /// Moves a tile to its place in the grid and appends it. Throws Error(LimitExceeded).
  void append(geometry::DecodedTile tile, const GridPoint& lower);
  std::uint64_t bytes() const { return all_.points.capacity() * bytesPerPoint_; }
  void moveInto(DecodedPoints& result);

 private:
  const DecodeLimits& limits_;
  std::uint64_t bytesPerPoint_;
  std::uint64_t cells_ = 0;
  geometry::DecodedTile all_;
};

/// Keeps `count` points, evenly spaced in the coder's order (so over space as well); the others
/// are counted to the one kept before them.
void thinTo(std::uint64_t count, DecodedPoints& points);

}  // namespace bspc
