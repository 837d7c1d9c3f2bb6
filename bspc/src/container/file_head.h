#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/limits.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "container/mesh_record.h"
#include "container/tile_layout.h"
#include "container/tile_record.h"

namespace bspc::container {

/// First bytes of every file. As PNG's, they do not survive a transfer that strips the top bit,
/// changes line ends or stops at a control-Z.
constexpr std::array<std::uint8_t, 8> kSignature{0x8B, 'B', 'S', 'P', '\r', '\n', 0x1A, '\n'};
constexpr unsigned kVersionMajor = 1;
constexpr unsigned kVersionMinor = 0;
/// Signature, major, minor.
constexpr std::size_t kPreambleSize = kSignature.size() + 2;

/// What the head block says (docs/format.md, "Head").
struct FileHead {
  unsigned layers = 1;
  bool streaming = false;       ///< the tile table stands in the index block at the end
  bool trailingBlocks = false;  ///< progressive layout: blocks follow the chunks
  Grid grid;
  std::vector<ArrayDescription> arrays;  ///< of the points, by name
  bool keepsOrder = false;               ///< points come back in the order of the input
  Metadata metadata;
  MeshRecord mesh;
  std::vector<TileRecord> tiles;  ///< progressive layout only

  /// Low halves of exact positions, if there are any, come before the named arrays.
  TileLayout layout() const;
  /// Arrays of the layout that have no names.
  std::size_t hiddenArrays() const;
};

/// The content of the head block.
Bytes writeHead(const FileHead& head);
FileHead readHead(ByteReader& in, const DecodeLimits& limits);

void writeTileTable(ByteWriter& out, const TileLayout& layout,
                    const std::vector<TileRecord>& tiles);
/// Bytes of memory that a tile of an open file takes at most, before it is decoded.
std::uint64_t memoryOfTile(const TileLayout& layout);
/// The table; `recordSizes` receives the bytes that each record takes.
std::vector<TileRecord> readTileTable(ByteReader& in, const TileLayout& layout,
                                      const DecodeLimits& limits,
                                      std::vector<std::size_t>* recordSizes);

}  // namespace bspc::container
