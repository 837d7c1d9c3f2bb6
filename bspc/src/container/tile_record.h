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
  GridPoint lower{};   ///< of the tight box
  GridPoint extent{};  ///< greatest coordinate from there
  /// Coarsest layers of the file that the tile has not: there the middle of its box stands for it.
  unsigned lacking = 0;
  std::vector<geometry::LayerSummary> coarse;  ///< of all layers but the last, lacking ones too
  std::uint64_t contentChecksum = 0;
  /// Payload bytes, a column of the chunk table each; kNoChunk for those of lacking layers.
  std::vector<std::uint64_t> chunkSizes;

  /// Puts so many layers that the tile has not in front of its own.
  void addLacking(unsigned layers);
};

/// In TileRecord::chunkSizes: there is no chunk.
constexpr std::uint64_t kNoChunk = 0xFFFFFFFFFFFFFFFF;

/// The point that stands for a tile in layers that it lacks, relative to its lower corner, and what
/// the index says of such a layer.
GridPoint middleOfBox(const GridPoint& extent);
geometry::LayerSummary lackingLayer(const GridPoint& extent);

void writeTileRecord(ByteWriter& out, const TileRecord& tile);
/// `layers` of geometry; `columns` chunks in all.
TileRecord readTileRecord(ByteReader& in, unsigned layers, std::size_t columns);

}  // namespace bspc::container
