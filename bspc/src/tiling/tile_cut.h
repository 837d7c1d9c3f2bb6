#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::tiling {

/// Which point goes into which tile.
struct TileCut {
  /// Indices of the points, tile by tile, ascending in each; empty if there is one tile, which
  /// then has all of them in order.
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> firsts;  ///< where each tile begins, and the number of points

  std::size_t tiles() const { return firsts.size() - 1; }
};

/// Cuts a point set into tiles of at most `most` points by the dyadic binary space partition: cells
/// are halved across their longest side until they have few enough points, and small cells that
/// follow one another are put together. At most 2^32 − 1 points.
TileCut cutTiles(Span<const GridPoint> points, std::size_t most);

}  // namespace bspc::tiling
