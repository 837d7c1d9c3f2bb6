#include "container/checksum.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>

#include "bspc/arrays.h"

namespace bspc::container {

namespace {

std::uint64_t cut(std::uint64_t hash, unsigned width) {
  return width == 8 ? hash : hash & ((std::uint64_t{1} << (8 * width)) - 1);
}

bool isLittleEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

}  // namespace

std::uint64_t checksum(ByteView bytes, unsigned width) {
  return cut(XXH3_64bits(bytes.data(), bytes.size()), width);
}

unsigned contentChecksumWidth(std::uint64_t points) {
  return points < 65536 / 12 + 1 ? checksumWidth(12 * points) : 8;
}

struct ContentChecksum::State {
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> hash{XXH3_createState(),
                                                                &XXH3_freeState};
  std::uint64_t points = 0;
};

ContentChecksum::ContentChecksum() : state_(std::make_unique<State>()) {
  XXH3_64bits_reset(state_->hash.get());
}
ContentChecksum::~ContentChecksum() = default;

void ContentChecksum::add(Span<const GridPoint> points) {
  static_assert(sizeof(GridPoint) == 12);
  state_->points += points.size();
  if (isLittleEndian()) {
    XXH3_64bits_update(state_->hash.get(), points.data(), 12 * points.size());
    return;
  }
  // Packed into little-endian bytes piece by piece.
  constexpr std::size_t kPiece = 1024;
  std::array<std::uint8_t, 12 * kPiece> piece{};
  for (std::size_t first = 0; first < points.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, points.size() - first);
    std::uint8_t* to = piece.data();
    for (const GridPoint& point : points.subspan(first, count)) {
      for (const std::uint32_t v : point) {
        *to++ = static_cast<std::uint8_t>(v);
        *to++ = static_cast<std::uint8_t>(v >> 8);
        *to++ = static_cast<std::uint8_t>(v >> 16);
        *to++ = static_cast<std::uint8_t>(v >> 24);
      }
    }
    XXH3_64bits_update(state_->hash.get(), piece.data(), 12 * count);
  }
}

std::uint64_t ContentChecksum::value() const {
  return cut(XXH3_64bits_digest(state_->hash.get()), contentChecksumWidth(state_->points));
}

std::uint64_t contentChecksum(Span<const GridPoint> points) {
  if (isLittleEndian()) {
    return cut(XXH3_64bits(points.data(), 12 * points.size()), contentChecksumWidth(points.size()));
  }
  ContentChecksum checksum;
  checksum.add(points);
  return checksum.value();
}

unsigned valuesChecksumWidth(const attributes::ArrayShape& shape, std::uint64_t points) {
  if (shape.type == ScalarType::String) return 8;
  const std::uint64_t tuple = shape.components * std::uint64_t{arrayValueSize(shape.type)};
  return points < 65536 ? checksumWidth(tuple * points) : 8;
}

std::uint64_t valuesChecksum(const attributes::ArrayShape& shape,
                             const attributes::ArrayValues& values, std::uint64_t points) {
  const unsigned width = valuesChecksumWidth(shape, points);
  if (shape.type != ScalarType::String) return checksum(values.numbers, width);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (const std::string& text : values.strings) {
    std::array<std::uint8_t, 8> length{};
    for (unsigned i = 0; i < 8; ++i) {
      length[i] = static_cast<std::uint8_t>(std::uint64_t{text.size()} >> (8 * i));
    }
    XXH3_64bits_update(state.get(), length.data(), length.size());
    XXH3_64bits_update(state.get(), text.data(), text.size());
  }
  return cut(XXH3_64bits_digest(state.get()), width);
}

}  // namespace bspc::container
