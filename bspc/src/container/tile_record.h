#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "geometry/geometry_method.h"

namespace bspc::container {

/// What the index says of a tile (docs/format.md, "Tile record").
struct TileRecord {
  unsigned method = 0;   ///< a Method, known to this version or not
  unsigned version = 0;  ///< of the method, 0 … 15
  std::uint64_t points = 0;
  GridPoint lower{};                           ///< of the tight box
  GridPoint extent{};                          ///< greatest coordinate from there
  std::vector<geometry::LayerSummary> coarse;  ///< of all layers but the last
  std::uint64_t contentChecksum = 0;
  std::vector<std::uint64_t> chunkSizes;  ///< payload bytes, a column of the chunk table each
};

void writeTileRecord(ByteWriter& out, const TileRecord& tile);
/// `layers` of geometry; `columns` chunks in all.
TileRecord readTileRecord(ByteReader& in, unsigned layers, std::size_t columns);

}  // namespace bspc::container
