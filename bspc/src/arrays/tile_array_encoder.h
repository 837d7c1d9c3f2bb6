#pragma once

#include <cstdint>
#include <vector>

#include "arrays/array_source.h"
#include "bspc/grid.h"
#include "container/tile_record.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// The arrays of a tile and the order of its points, ready for a file.
struct CodedTileArrays {
  container::TileOrder order = container::TileOrder::Unknown;
  Bytes orderPayload;
  bool layered = false;
  std::vector<container::TileArray> arrays;
  std::vector<std::vector<Bytes>> payloads;  ///< by array, then by layer that has values
  std::vector<double> greatestErrors;        ///< by array
};

/// A tile whose geometry is coded, in decoded order.
struct TileWithArrays {
  const geometry::EncodedTile& geometry;
  Span<const GridPoint> points;               ///< as decoded, from the tile's lower corner
  const std::vector<std::uint64_t>& sources;  ///< input index of each
};

/// Codes the arrays of tiles, on any number of threads at a time.
class TileArrayEncoder {
 public:
  TileArrayEncoder(ArraySource source, unsigned effort, bool keepsOrder)
      : source_(source), effort_(effort), keepsOrder_(keepsOrder) {}

  const ArraySource& source() const { return source_; }
  unsigned effort() const { return effort_; }
  bool keepsOrder() const { return keepsOrder_; }
  /// The order is stored where an array needs it, even if the file does not promise it.
  void storeOrder(bool store) { storesOrder_ = store; }
  bool hasWork() const { return keepsOrder_ || source_.size() > 0; }
  CodedTileArrays encode(const TileWithArrays& tile) const;

 private:
  ArraySource source_;
  unsigned effort_;
  bool keepsOrder_;
  bool storesOrder_ = false;
};

}  // namespace bspc
