#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"
#include "container/tile_record.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// A tile that is ready to go into a file.
struct FinishedTile {
  container::TileRecord record;
  std::vector<Bytes> chunks;
  std::vector<std::uint32_t> order;  ///< order[j]: index in the tile of the j-th decoded point
  /// See EncodedTile: where points stand after a lossy coding.
  std::vector<GridPoint> decoded;
};

/// Codes tiles, on any number of threads at a time.
class TileEncoder {
 public:
  TileEncoder(const geometry::GeometryMethod& method, unsigned layers,
              const geometry::CodingWishes& wishes)
      : method_(method), layers_(layers), wishes_(wishes) {}

  /// Codes a tile of at least one point.
  FinishedTile encode(Span<const GridPoint> points, const geometry::PointProgress& progress) const;

 private:
  const geometry::GeometryMethod& method_;
  unsigned layers_;
  geometry::CodingWishes wishes_;
};

}  // namespace bspc
