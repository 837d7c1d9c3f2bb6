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

// The flags of the fields about arrays.
constexpr unsigned kOrderMask = 3;
constexpr unsigned kLayeredArrays = 1U << 2;

unsigned byteLength(std::uint32_t value) {
  return std::max(1U, (entropy::bitLength(value) + 7) / 8);
}

std::uint64_t readChunkSize(ByteReader& in) {
  const std::uint64_t size = in.varint();
  if (size == kNoChunk) in.fail("a chunk of 2^64 - 1 bytes");
  return size;
}

}  // namespace

GridPoint middleOfBox(const GridPoint& extent) {
  return {extent[0] / 2, extent[1] / 2, extent[2] / 2};
}

geometry::LayerSummary lackingLayer(const GridPoint& extent) {
  const std::uint32_t longest = *std::max_element(extent.begin(), extent.end());
  return {1, longest - longest / 2};
}

bool TileRecord::hasChunk(const TileLayout& layout, std::size_t column) const {
  const unsigned layer = layout.layerOf(column);
  switch (layout.partOf(column)) {
    case kGeometryPart:
      return layer >= lacking;
    case kOrderPart:
      return order == TileOrder::Stored && layer + 1 == layout.layers;
    default:
      return layer >= firstArrayLayer(layout.layers);
  }
}

void TileRecord::addLacking(unsigned layers) {
  lacking += layers;
  coarse.insert(coarse.begin(), layers, lackingLayer(extent));
}

namespace {

/// The fields about arrays and the order, and the sizes of their chunks.
void writeArrayFields(ByteWriter& out, const TileLayout& layout, const TileRecord& tile) {
  const unsigned last = layout.layers - 1;
  const bool stored = tile.order == TileOrder::Stored;
  out.u8((tile.layeredArrays ? kLayeredArrays : 0) | static_cast<unsigned>(tile.order));
  if (stored) out.varint(tile.chunkSizes[layout.column(last, kOrderPart)]);
  for (std::size_t a = 0; a < layout.arrays.size(); ++a) {
    out.unsignedLittle(tile.arrays[a].contentChecksum,
                       valuesChecksumWidth(layout.arrays[a], tile.points));
    for (unsigned l = tile.firstArrayLayer(layout.layers); l < layout.layers; ++l) {
      const std::uint64_t size = tile.chunkSizes[layout.column(l, kFirstArrayPart + a)];
      out.varint(stored && l == last ? 2 * size + (tile.arrays[a].needsOrder ? 1 : 0) : size);
    }
  }
}

void readArrayFields(ByteReader& in, const TileLayout& layout, TileRecord& tile) {
  const unsigned last = layout.layers - 1;
  const unsigned flags = in.u8();
  const unsigned order = flags & kOrderMask;
  if (flags > (kLayeredArrays | kOrderMask) || order > static_cast<unsigned>(TileOrder::Decoded)) {
    in.fail("the arrays of a tile have unknown flags");
  }
  tile.layeredArrays = (flags & kLayeredArrays) != 0;
  tile.order = static_cast<TileOrder>(order);
  if (layout.keepsOrder && tile.order == TileOrder::Unknown) {
    in.fail("a tile has no order in a file that keeps it");
  }
  const bool stored = tile.order == TileOrder::Stored;
  if (stored) tile.chunkSizes[layout.column(last, kOrderPart)] = readChunkSize(in);
  for (std::size_t a = 0; a < layout.arrays.size(); ++a) {
    TileArray array;
    array.contentChecksum = in.unsignedLittle(valuesChecksumWidth(layout.arrays[a], tile.points));
    for (unsigned l = tile.firstArrayLayer(layout.layers); l < layout.layers; ++l) {
      std::uint64_t size = readChunkSize(in);
      if (stored && l == last) {
        array.needsOrder = (size & 1) != 0;
        size /= 2;
      }
      tile.chunkSizes[layout.column(l, kFirstArrayPart + a)] = size;
    }
    tile.arrays.push_back(array);
  }
}

}  // namespace

void writeTileRecord(ByteWriter& out, const TileLayout& layout, const TileRecord& tile) {
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
  for (unsigned l = tile.lacking; l < layout.layers; ++l) {
    out.varint(tile.chunkSizes[layout.column(l, kGeometryPart)]);
  }
  if (layout.hasArrayFields()) writeArrayFields(out, layout, tile);
}

TileRecord readTileRecord(ByteReader& in, const TileLayout& layout) {
  TileRecord tile;
  const unsigned flags = in.u8();
  const std::uint32_t coder = in.varint32();
  tile.method = coder >> kVersionBits;
  tile.version = coder & ((1U << kVersionBits) - 1);
  tile.points = in.varint();
  if (tile.points == 0) in.fail("a tile without points");
  if ((flags & kHasLower) != 0) {
    for (std::uint32_t& v : tile.lower) v = in.varint32();
    if (tile.lower == GridPoint{}) in.fail("a tile tells a lower corner of zeros");
  }
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned width = ((flags >> (2 * k)) & 3) + 1;
    tile.extent[k] = static_cast<std::uint32_t>(in.unsignedLittle(width));
    if (width != byteLength(tile.extent[k])) in.fail("an extent is longer than it must be");
    if (tile.extent[k] > std::numeric_limits<std::uint32_t>::max() - tile.lower[k]) {
      in.fail("the box of a tile leaves the grid");
    }
  }
  if ((flags & kLacksLayers) != 0) {
    tile.lacking = in.varint32();
    if (tile.lacking == 0 || tile.lacking >= layout.layers) in.fail("a tile lacks no layer or all");
    tile.coarse.assign(tile.lacking, lackingLayer(tile.extent));
  }
  for (unsigned l = tile.lacking; l + 1 < layout.layers; ++l) {
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
  tile.chunkSizes.assign(layout.columns(), kNoChunk);
  for (unsigned l = tile.lacking; l < layout.layers; ++l) {
    tile.chunkSizes[layout.column(l, kGeometryPart)] = readChunkSize(in);
  }
  if (layout.hasArrayFields()) readArrayFields(in, layout, tile);
  return tile;
}

}  // namespace bspc::container
