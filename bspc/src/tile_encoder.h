#pragma once

#include <cstdint>
#include <vector>

#include "arrays/tile_array_encoder.h"
#include "bspc/grid.h"
#include "bspc/span.h"
#include "container/tile_record.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// A tile that is ready to go into a file.
struct FinishedTile {
  container::TileRecord record;
  std::vector<Bytes> chunks;  ///< as ContainerWriter takes them
  /// Input index of the j-th decoded point; empty if the caller gave none.
  std::vector<std::uint64_t> sources;
  std::uint64_t geometryBytes = 0;
  std::uint64_t orderBytes = 0;
  std::vector<std::uint64_t> arrayBytes;
  std::vector<double> arrayErrors;  ///< greatest of each array
  /// See EncodedTile: where points stand after a lossy coding.
  std::vector<GridPoint> decoded;
  Cells faces;  ///< that the payload of its points holds, over the decoded points
};

/// Codes tiles, on any number of threads at a time.
class TileEncoder {
 public:
  TileEncoder(const geometry::GeometryMethod& method, unsigned layers,
              const geometry::CodingWishes& wishes, const TileArrayEncoder& arrays)
      : method_(method), layers_(layers), wishes_(wishes), arrays_(arrays) {}

  /// Codes a tile of at least one point. `sources`: input index of each; only needed for arrays
  /// and if the caller wants them back in decoded order.
  FinishedTile encode(Span<const GridPoint> points, const std::vector<std::uint64_t>& sources,
                      const geometry::PointProgress& progress) const;

 private:
  void addArrays(CodedTileArrays arrays, geometry::EncodedTile& coded,
                 FinishedTile& finished) const;

  const geometry::GeometryMethod& method_;
  unsigned layers_;
  geometry::CodingWishes wishes_;
  const TileArrayEncoder& arrays_;
};

}  // namespace bspc
