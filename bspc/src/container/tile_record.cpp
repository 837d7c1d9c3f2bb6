#include "container/tile_record.h"

#include <algorithm>
#include <limits>

#include "container/checksum.h"
#include "entropy/symbol_coder.h"

namespace bspc::container {

namespace {

constexpr unsigned kHasLower = 1U << 6;
constexpr unsigned kLacksLayers = 1U << 7;
constexpr unsigned kVersionBits = 4;

unsigned byteLength(std::uint32_t value) {
  return std::max(1U, (entropy::bitLength(value) + 7) / 8);
}

}  // namespace

GridPoint middleOfBox(const GridPoint& extent) {
  return {extent[0] / 2, extent[1] / 2, extent[2] / 2};
}

geometry::LayerSummary lackingLayer(const GridPoint& extent) {
  const std::uint32_t longest = *std::max_element(extent.begin(), extent.end());
  return {1, longest - longest / 2};
}

void TileRecord::addLacking(unsigned layers) {
  lacking += layers;
  coarse.insert(coarse.begin(), layers, lackingLayer(extent));
  chunkSizes.insert(chunkSizes.begin(), layers, kNoChunk);
}

void writeTileRecord(ByteWriter& out, const TileRecord& tile) {
  unsigned flags = tile.lower == GridPoint{} ? 0 : kHasLower;
  for (unsigned k = 0; k < 3; ++k) flags |= (byteLength(tile.extent[k]) - 1) << (2 * k);
  if (tile.lacking > 0) flags |= kLacksLayers;
  out.u8(flags);
  out.varint((std::uint64_t{tile.method} << kVersionBits) | tile.version);
  out.varint(tile.points);
  if ((flags & kHasLower) != 0) {
    for (const std::uint32_t v : tile.lower) out.varint(v);
  }
  for (const std::uint32_t v : tile.extent) out.unsignedLittle(v, byteLength(v));
  if (tile.lacking > 0) out.varint(tile.lacking);
  for (std::size_t l = tile.lacking; l < tile.coarse.size(); ++l) {
    out.varint(tile.coarse[l].representatives);
    out.varint(tile.coarse[l].spread);
  }
  out.unsignedLittle(tile.contentChecksum, contentChecksumWidth(tile.points));
  for (const std::uint64_t size : tile.chunkSizes) {
    if (size != kNoChunk) out.varint(size);
  }
}

TileRecord readTileRecord(ByteReader& in, unsigned layers, std::size_t columns) {
  TileRecord tile;
  const unsigned flags = in.u8();
  const std::uint32_t coder = in.varint32();
  tile.method = coder >> kVersionBits;
  tile.version = coder & ((1U << kVersionBits) - 1);
  tile.points = in.varint();
  if (tile.points == 0) in.fail("a tile without points");
  if ((flags & kHasLower) != 0) {
    for (std::uint32_t& v : tile.lower) v = in.varint32();
  }
  for (unsigned k = 0; k < 3; ++k) {
    tile.extent[k] = static_cast<std::uint32_t>(in.unsignedLittle(((flags >> (2 * k)) & 3) + 1));
    if (tile.extent[k] > std::numeric_limits<std::uint32_t>::max() - tile.lower[k]) {
      in.fail("the box of a tile leaves the grid");
    }
  }
  if ((flags & kLacksLayers) != 0) {
    tile.lacking = in.varint32();
    if (tile.lacking == 0 || tile.lacking >= layers) in.fail("a tile lacks no layer or all");
    tile.coarse.assign(tile.lacking, lackingLayer(tile.extent));
  }
  for (unsigned l = tile.lacking; l + 1 < layers; ++l) {
    geometry::LayerSummary layer;
    layer.representatives = in.varint();
    layer.spread = in.varint32();
    const std::uint64_t before = tile.coarse.empty() ? 1 : tile.coarse.back().representatives;
    if (layer.representatives < before || layer.representatives > tile.points) {
      in.fail("the layers of a tile do not grow up to its points");
    }
    tile.coarse.push_back(layer);
  }
  tile.contentChecksum = in.unsignedLittle(contentChecksumWidth(tile.points));
  for (std::size_t c = 0; c < columns; ++c) {
    tile.chunkSizes.push_back(c < tile.lacking ? kNoChunk : in.varint());
    if (c >= tile.lacking && tile.chunkSizes.back() == kNoChunk)
      in.fail("a chunk of 2^64 - 1 bytes");
  }
  return tile;
}

}  // namespace bspc::container
