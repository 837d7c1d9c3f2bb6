#include "container/file_head.h"

#include <string>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "container/grid_record.h"

namespace bspc::container {

namespace {

constexpr unsigned kLayersMask = 31;
constexpr unsigned kStreaming = 1U << 5;
constexpr unsigned kHasRecords = 1U << 6;
constexpr unsigned kTrailingBlocks = 1U << 7;
constexpr unsigned kOptionalRecord = 128;
static_assert(kMaxLayers == kLayersMask + 1);

/// This version knows no records; optional ones are passed over.
void readRecords(ByteReader& in) {
  const std::uint64_t count = in.varint();
  if (count == 0) in.fail("an empty list of records");
  for (std::uint64_t i = 0; i < count; ++i) {
    const unsigned tag = in.u8();
    if (tag < kOptionalRecord) {
      throw Error(ErrorCode::Unsupported,
                  "the head has a record of type " + std::to_string(tag) +
                      ", which this version does not know and may not pass over; use a newer one");
    }
    in.bytes(in.varint());
  }
}

}  // namespace

void writeTileTable(ByteWriter& out, const std::vector<TileRecord>& tiles) {
  out.varint(tiles.size());
  for (const TileRecord& tile : tiles) writeTileRecord(out, tile);
}

std::vector<TileRecord> readTileTable(ByteReader& in, const FileHead& head,
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
    const std::size_t start = in.position();
    tiles.push_back(readTileRecord(in, head.layers, head.columns()));
    if (recordSizes != nullptr) recordSizes->push_back(in.position() - start);
  }
  return tiles;
}

Bytes writeHead(const FileHead& head) {
  ByteWriter out;
  out.u8((head.layers - 1) | (head.streaming ? kStreaming : 0) |
         (head.trailingBlocks ? kTrailingBlocks : 0));
  writeGrid(out, head.grid);
  if (!head.streaming) writeTileTable(out, head.tiles);
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
  if ((flags & kHasRecords) != 0) readRecords(in);
  if (!head.streaming) head.tiles = readTileTable(in, head, limits, nullptr);
  in.expectEnd();
  return head;
}

}  // namespace bspc::container
