#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "container/tile_layout.h"
#include "geometry/geometry_method.h"

namespace bspc::container {

/// What is known of the order in which a tile's points came in. The values are those of the format.
enum class TileOrder : std::uint8_t {
  Unknown = 0,
  Stored = 1,   ///< a chunk of the last layer has it
  Decoded = 2,  ///< it is the order in which they are decoded
};

/// What the index says of an array in a tile.
struct TileArray {
  std::uint64_t contentChecksum = 0;  ///< of its values in decoded order
  bool needsOrder = false;            ///< its last chunk is decoded with the help of the order
};

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
  TileOrder order = TileOrder::Unknown;
  /// Every layer that the tile has holds values of the arrays: its representatives are points of
  /// the tile. Otherwise the last one alone does.
  bool layeredArrays = false;
  std::vector<TileArray> arrays;  ///< one for each array of the layout
  /// Payload bytes by column of the layout; kNoChunk where the tile has none.
  std::vector<std::uint64_t> chunkSizes;

  /// Whether the tile has a chunk in a column.
  bool hasChunk(const TileLayout& layout, std::size_t column) const;
  /// The first layer in which arrays have values.
  unsigned firstArrayLayer(unsigned layers) const { return layeredArrays ? lacking : layers - 1; }
  /// Puts so many layers that the tile has not in front of its own; chunkSizes stay as they are.
  void addLacking(unsigned layers);
};

/// In TileRecord::chunkSizes: there is no chunk.
constexpr std::uint64_t kNoChunk = 0xFFFFFFFFFFFFFFFF;

/// The point that stands for a tile in layers that it lacks, relative to its lower corner, and what
/// the index says of such a layer.
GridPoint middleOfBox(const GridPoint& extent);
geometry::LayerSummary lackingLayer(const GridPoint& extent);

void writeTileRecord(ByteWriter& out, const TileLayout& layout, const TileRecord& tile);
TileRecord readTileRecord(ByteReader& in, const TileLayout& layout);

}  // namespace bspc::container
