#include "arrays/tile_array_decoder.h"

#include <numeric>
#include <string>

#include "arrays/array_tuples.h"
#include "attributes/order_coder.h"
#include "attributes/tile_points.h"
#include "bspc/error.h"
#include "container/checksum.h"
#include "saturating.h"

namespace bspc {

namespace {

/// Whether decoding takes the chunk with the order of the input.
bool needsOrderChunk(const container::TileRecord& record, bool isLast,
                     const std::vector<std::size_t>& arrays, bool wantOrder) {
  if (!isLast || record.order != container::TileOrder::Stored) return false;
  bool needed = wantOrder;
  for (const std::size_t a : arrays) needed = needed || record.arrays[a].needsOrder;
  return needed;
}

std::uint64_t memoryOf(const attributes::ArrayShape& shape, const attributes::ArrayValues& values) {
  std::uint64_t bytes = values.numbers.capacity();
  if (shape.type == ScalarType::String) {
    for (const std::string& text : values.strings) bytes += sizeof(std::string) + text.size();
  }
  return bytes;
}

}  // namespace

DecodedTileArrays TileArrayDecoder::decode(const std::vector<std::size_t>& arrays, bool wantOrder,
                                           std::uint64_t maxBytes) {
  maxBytes_ = maxBytes;
  used_ = 0;
  DecodedTileArrays result;
  result.arrays.resize(arrays.size());
  const std::vector<std::uint32_t>& layers = points_.layerOrder;
  const bool reordered = record_.layeredArrays && !layers.empty();
  if (reordered && !arrays.empty()) {
    used_ += points_.points.size() * sizeof(GridPoint);
    if (used_ > maxBytes_) {
      throw Error(ErrorCode::LimitExceeded,
                  "decoding arrays needs more memory than the limit; raise the limit if the file "
                  "is to be trusted");
    }
    layered_.reserve(layers.size());
    for (const std::uint32_t i : layers) layered_.push_back(points_.points[i]);
  }
  decodeOrder(arrays, wantOrder, result);
  for (unsigned l = record_.firstArrayLayer(layout_.layers); l <= level_ && !arrays.empty(); ++l) {
    decodeLayer(l, arrays, result);
  }
  if (isLast()) check(arrays, result);
  if (reordered) {
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      ArrayTuples(layout_.arrays[arrays[i]])
          .scatter(result.arrays[i].numbers, result.arrays[i].strings, layers);
    }
  }
  return result;
}

void TileArrayDecoder::decodeOrder(const std::vector<std::size_t>& arrays, bool wantOrder,
                                   DecodedTileArrays& result) {
  if (!isLast() || record_.order == container::TileOrder::Unknown) return;
  std::vector<std::uint32_t> order;
  if (record_.order == container::TileOrder::Decoded) {
    if (arrays.empty()) return;
    order.resize(points_.points.size());
    std::iota(order.begin(), order.end(), 0U);
  } else {
    if (!needsOrderChunk(record_, isLast(), arrays, wantOrder)) return;
    const Bytes payload = readChunk_(layout_.column(layout_.layers - 1, container::kOrderPart));
    order = attributes::decodeOrder(points_.points, payload, freeBytes());
  }
  used_ += 2 * order.size() * sizeof(std::uint32_t);
  if (record_.layeredArrays && !points_.layerOrder.empty()) {
    inputOrder_.reserve(order.size());
    for (const std::uint32_t i : points_.layerOrder) inputOrder_.push_back(order[i]);
  } else {
    inputOrder_ = order;
  }
  if (wantOrder && record_.order == container::TileOrder::Stored) result.order = std::move(order);
}

std::size_t TileArrayDecoder::pointsUpTo(unsigned layer) const {
  return layer == level_ ? points_.points.size()
                         : static_cast<std::size_t>(record_.coarse[layer].representatives);
}

void TileArrayDecoder::decodeLayer(unsigned layer, const std::vector<std::size_t>& arrays,
                                   DecodedTileArrays& result) {
  const std::size_t begin =
      layer == record_.firstArrayLayer(layout_.layers) ? 0 : pointsUpTo(layer - 1);
  const std::size_t end = pointsUpTo(layer);
  const Span<const GridPoint> all(layered_.empty() ? points_.points : layered_);
  attributes::TilePoints points(all.subspan(0, end), begin);
  if (layer + 1 == layout_.layers && !inputOrder_.empty()) {
    points.setInputOrder(Span<const std::uint32_t>(inputOrder_).subspan(begin, end - begin));
  }
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const attributes::ArrayShape& shape = layout_.arrays[arrays[i]];
    attributes::ArrayValues& values = result.arrays[i];
    const Bytes payload = readChunk_(layout_.column(layer, container::kFirstArrayPart + arrays[i]));
    const std::uint64_t before = memoryOf(shape, values);
    used_ += payload.size();
    attributes::decodeArray(shape, payload, points, freeBytes(), values);
    used_ += memoryOf(shape, values) - before - payload.size();
    if (ArrayTuples(shape).count(values) != end) {
      throw Error(ErrorCode::Corrupt, "an array has other tuples than points");
    }
  }
}

void TileArrayDecoder::check(const std::vector<std::size_t>& arrays,
                             const DecodedTileArrays& result) const {
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const std::size_t a = arrays[i];
    const std::uint64_t sum =
        container::valuesChecksum(layout_.arrays[a], result.arrays[i], points_.points.size());
    if (sum == record_.arrays[a].contentChecksum) continue;
    throw Error(ErrorCode::Corrupt,
                "the values of array " + std::to_string(a) +
                    " in a tile are not those that were written (wrong content checksum): the "
                    "file is damaged, or this machine does not calculate as it should");
  }
}

std::uint64_t bytesOfArrays(const container::ContainerReader& file, std::size_t tile,
                            unsigned level, const std::vector<std::size_t>& arrays,
                            bool wantOrder) {
  const container::TileLayout& layout = file.layout();
  const container::TileRecord& record = file.tiles()[tile];
  std::uint64_t bytes = 0;
  for (unsigned l = record.firstArrayLayer(layout.layers); l <= level; ++l) {
    for (const std::size_t a : arrays) {
      bytes = saturatingAdd(
          bytes, file.bytesOfChunk(tile, layout.column(l, container::kFirstArrayPart + a)));
    }
  }
  if (needsOrderChunk(record, level + 1 == layout.layers, arrays, wantOrder)) {
    bytes = saturatingAdd(
        bytes, file.bytesOfChunk(tile, layout.column(layout.layers - 1, container::kOrderPart)));
  }
  return bytes;
}

}  // namespace bspc
