// Plain coders behind the interfaces of attributes/, until the real ones are there.

#include <cstring>
#include <string>

#include "arrays/array_tuples.h"
#include "attributes/array_coder.h"
#include "attributes/order_coder.h"
#include "bspc/error.h"
#include "container/array_table.h"
#include "container/packed_bytes.h"

namespace bspc::attributes {

TilePoints::TilePoints(Span<const GridPoint> points, std::size_t known)
    : points_(points), known_(known) {}

void TilePoints::setInputOrder(Span<const std::uint32_t> order) { inputOrder_ = order; }

EncodedArray encodeArray(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                         const ArrayWishes& /*wishes*/) {
  const ArrayTuples tuples(shape);
  if (tuples.count(values) != points.size()) {
    throw Error(ErrorCode::InvalidArgument, "an array has other tuples than points");
  }
  ArrayValues added;
  tuples.append(added, values, points.known(), points.added());
  container::ByteWriter plain;
  for (const std::string& text : added.strings) container::writeText(plain, text);
  plain.bytes(added.numbers);
  container::ByteWriter packed;
  container::writePacked(packed, plain.data(), 3);
  EncodedArray coded;
  coded.payload = packed.take();
  coded.usesInputOrder = false;
  return coded;
}

void decodeArray(const ArrayShape& shape, ByteView payload, TilePoints& points,
                 std::uint64_t maxBytes, ArrayValues& values) {
  container::ByteReader packed(payload, "an array", container::ByteReader::kNoOffset);
  const Bytes bytes = container::readPacked(packed, maxBytes);
  container::ByteReader in(bytes, "an array", container::ByteReader::kNoOffset);
  if (shape.type == ScalarType::String) {
    const std::uint64_t count = std::uint64_t{points.added()} * shape.components;
    for (std::uint64_t i = 0; i < count; ++i) values.strings.push_back(container::readText(in));
  } else {
    const ByteView all = in.bytes(in.remaining());
    values.numbers.insert(values.numbers.end(), all.begin(), all.end());
  }
  in.expectEnd();
}

Bytes encodeOrder(Span<const GridPoint> /*points*/, Span<const std::uint32_t> order) {
  Bytes bytes(order.size() * sizeof(std::uint32_t));
  std::memcpy(bytes.data(), order.data(), bytes.size());
  return bytes;
}

std::vector<std::uint32_t> decodeOrder(Span<const GridPoint> points, ByteView payload,
                                       std::uint64_t maxBytes) {
  std::vector<std::uint32_t> order(payload.size() / sizeof(std::uint32_t));
  if (order.size() != points.size() || payload.size() > maxBytes) {
    throw Error(ErrorCode::Corrupt, "an order has other indices than points");
  }
  std::memcpy(order.data(), payload.data(), payload.size());
  std::vector<bool> seen(order.size());
  for (const std::uint32_t i : order) {
    if (i >= seen.size() || seen[i]) throw Error(ErrorCode::Corrupt, "an order is none");
    seen[i] = true;
  }
  return order;
}

}  // namespace bspc::attributes
