#include "container/file_head.h"

#include <string>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "container/array_table.h"
#include "container/grid_record.h"
#include "container/metadata_record.h"
#include "grid/float_grid.h"

namespace bspc::container {

namespace {

constexpr unsigned kLayersMask = 31;
constexpr unsigned kStreaming = 1U << 5;
constexpr unsigned kHasRecords = 1U << 6;
constexpr unsigned kTrailingBlocks = 1U << 7;
constexpr unsigned kOptionalRecord = 128;
static_assert(kMaxLayers == kLayersMask + 1);

bool hasRecords(const FileHead& head) {
  return head.keepsOrder || !head.arrays.empty() || !head.metadata.empty() || head.mesh.blocks > 0;
}

/// Tags of records (docs/format.md, "Head").
enum Record : unsigned { kArrays = 1, kKeptOrder = 2, kMesh = 3, kMetadata = 128 };

void writeRecord(ByteWriter& out, unsigned tag, ByteView content) {
  out.u8(tag);
  out.varint(content.size());
  out.bytes(content);
}

void writeRecords(ByteWriter& out, const FileHead& head) {
  out.varint((head.arrays.empty() ? 0U : 1U) + (head.keepsOrder ? 1U : 0U) +
             (head.mesh.blocks > 0 ? 1U : 0U) + (head.metadata.empty() ? 0U : 1U));
  if (!head.arrays.empty()) {
    ByteWriter table;
    writeArrayTable(table, head.arrays);
    writeRecord(out, kArrays, table.data());
  }
  if (head.keepsOrder) writeRecord(out, kKeptOrder, {});
  if (head.mesh.blocks > 0) {
    ByteWriter mesh;
    writeMeshRecord(mesh, head.mesh);
    writeRecord(out, kMesh, mesh.data());
  }
  if (!head.metadata.empty()) {
    ByteWriter metadata;
    writeMetadata(metadata, head.metadata);
    writeRecord(out, kMetadata, metadata.data());
  }
}

void readRecord(unsigned tag, ByteView content, const DecodeLimits& limits, FileHead& head) {
  ByteReader in(content, "a record of the head", ByteReader::kNoOffset);
  switch (tag) {
    case kArrays:
      head.arrays = readArrayTable(in, limits);
      break;
    case kKeptOrder:
      head.keepsOrder = true;
      break;
    case kMesh:
      head.mesh = readMeshRecord(in, limits);
      break;
    case kMetadata:
      head.metadata = readMetadata(in, limits);
      break;
    default:
      if (tag >= kOptionalRecord) return;
      throw Error(ErrorCode::Unsupported,
                  "the head has a record of type " + std::to_string(tag) +
                      ", which this version does not know and may not pass over; use a newer one");
  }
  in.expectEnd();
}

void readRecords(ByteReader& in, const DecodeLimits& limits, FileHead& head) {
  const std::uint64_t count = in.varint();
  if (count == 0) in.fail("an empty list of records");
  int before = -1;
  for (std::uint64_t i = 0; i < count; ++i) {
    const unsigned tag = in.u8();
    if (static_cast<int>(tag) <= before) in.fail("records that are not in the order of their tags");
    before = static_cast<int>(tag);
    readRecord(tag, in.bytes(in.varint()), limits, head);
  }
}

}  // namespace

std::size_t FileHead::hiddenArrays() const { return lattice::hasLowHalves(grid) ? 1 : 0; }

TileLayout FileHead::layout() const {
  TileLayout layout;
  layout.layers = layers;
  layout.keepsOrder = keepsOrder;
  if (hiddenArrays() > 0) layout.arrays.push_back({ScalarType::UInt32, 3, Semantic::None});
  for (const ArrayDescription& array : arrays) {
    layout.arrays.push_back({array.type, array.components, array.semantic});
  }
  return layout;
}

void writeTileTable(ByteWriter& out, const TileLayout& layout,
                    const std::vector<TileRecord>& tiles) {
  out.varint(tiles.size());
  for (const TileRecord& tile : tiles) writeTileRecord(out, layout, tile);
}

std::uint64_t memoryOfTile(const TileLayout& layout) {
  // The record, what is told of it, and where it stands; while arrays of these grow, the old ones
  // stand beside them. Columns have a size and an offset even where the file has no chunk.
  constexpr std::uint64_t kRecords = 4 * sizeof(TileRecord);
  return kRecords + 2 * sizeof(geometry::LayerSummary) * layout.layers +
         2 * layout.arrays.size() * sizeof(TileArray) +
         4 * layout.columns() * sizeof(std::uint64_t);
}

std::vector<TileRecord> readTileTable(ByteReader& in, const TileLayout& layout,
                                      const DecodeLimits& limits,
                                      std::vector<std::size_t>* recordSizes) {
  const std::uint64_t count = in.varint();
  if (count > limits.tiles) {
    throw Error(ErrorCode::LimitExceeded,
                "the file has " + std::to_string(count) + " tiles, more than the limit of " +
                    std::to_string(limits.tiles) + "; raise the limit if it is to be trusted");
  }
  std::vector<TileRecord> tiles;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i >= limits.memoryBytes / memoryOfTile(layout)) {
      throw Error(ErrorCode::LimitExceeded,
                  "the table of tiles needs more memory than the limit of " +
                      std::to_string(limits.memoryBytes) +
                      " bytes; raise the limit if the file is to be trusted");
    }
    const std::size_t start = in.position();
    tiles.push_back(readTileRecord(in, layout));
    if (recordSizes != nullptr) recordSizes->push_back(in.position() - start);
  }
  return tiles;
}

Bytes writeHead(const FileHead& head) {
  ByteWriter out;
  out.u8((head.layers - 1) | (head.streaming ? kStreaming : 0) |
         (head.trailingBlocks ? kTrailingBlocks : 0) | (hasRecords(head) ? kHasRecords : 0));
  writeGrid(out, head.grid);
  if (hasRecords(head)) writeRecords(out, head);
  if (!head.streaming) writeTileTable(out, head.layout(), head.tiles);
  return out.take();
}

FileHead readHead(ByteReader& in, const DecodeLimits& limits) {
  FileHead head;
  const unsigned flags = in.u8();
  head.layers = (flags & kLayersMask) + 1;
  head.streaming = (flags & kStreaming) != 0;
  head.trailingBlocks = (flags & kTrailingBlocks) != 0;
  if (head.streaming && head.trailingBlocks) in.fail("contradicting layout flags");
  head.grid = readGrid(in);
  if ((flags & kHasRecords) != 0) readRecords(in, limits, head);
  if (!head.streaming) head.tiles = readTileTable(in, head.layout(), limits, nullptr);
  in.expectEnd();
  return head;
}

}  // namespace bspc::container
