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

/// XXH3 of bytes that come piece by piece.
class Hash {
 public:
  Hash() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

  void add(const void* bytes, std::size_t size) { XXH3_64bits_update(state_.get(), bytes, size); }

  /// Numbers as little-endian bytes.
  void addNumbers(const std::uint32_t* numbers, std::size_t size) {
    if (isLittleEndian()) {
      if (size > 0) add(numbers, 4 * size);
      return;
    }
    constexpr std::size_t kPiece = 3072;
    std::array<std::uint8_t, 4 * kPiece> piece{};
    for (std::size_t first = 0; first < size; first += kPiece) {
      const std::size_t count = std::min(kPiece, size - first);
      for (std::size_t i = 0; i < 4 * count; ++i) {
        piece[i] = static_cast<std::uint8_t>(numbers[first + i / 4] >> (8 * (i % 4)));
      }
      add(piece.data(), 4 * count);
    }
  }

  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

}  // namespace

std::uint64_t checksum(ByteView bytes, unsigned width) {
  return cut(XXH3_64bits(bytes.data(), bytes.size()), width);
}

unsigned contentChecksumWidth(std::uint64_t points) {
  return points < 65536 / 12 + 1 ? checksumWidth(12 * points) : 8;
}

struct ContentChecksum::State {
  Hash hash;
  std::uint64_t points = 0;
};

ContentChecksum::ContentChecksum() : state_(std::make_unique<State>()) {}
ContentChecksum::~ContentChecksum() = default;

void ContentChecksum::add(Span<const GridPoint> points) {
  static_assert(sizeof(GridPoint) == 12);
  state_->points += points.size();
  state_->hash.addNumbers(points.empty() ? nullptr : points[0].data(), 3 * points.size());
}

std::uint64_t ContentChecksum::value() const {
  return cut(state_->hash.value(), contentChecksumWidth(state_->points));
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
  Hash hash;
  for (const std::string& text : values.strings) {
    std::array<std::uint8_t, 8> length{};
    for (unsigned i = 0; i < 8; ++i) {
      length[i] = static_cast<std::uint8_t>(std::uint64_t{text.size()} >> (8 * i));
    }
    hash.add(length.data(), length.size());
    hash.add(text.data(), text.size());
  }
  return cut(hash.value(), width);
}

unsigned cellsChecksumWidth(std::uint64_t cells) {
  return cells < 65536 / 16 ? checksumWidth(16 * cells) : 8;
}

std::uint64_t cellsChecksum(const MeshCells& cells) {
  Hash hash;
  for (const Cells* sort : {&cells.vertices, &cells.lines, &cells.faces}) {
    std::array<std::uint32_t, 1024> sizes{};
    for (std::size_t first = 0; first < sort->size(); first += sizes.size()) {
      const std::size_t count = std::min(sizes.size(), sort->size() - first);
      for (std::size_t i = 0; i < count; ++i) {
        sizes[i] = sort->ends[first + i] - sort->first(first + i);
      }
      hash.addNumbers(sizes.data(), count);
    }
    hash.addNumbers(sort->indices.data(), sort->indices.size());
  }
  return cut(hash.value(), cellsChecksumWidth(cells.size()));
}

}  // namespace bspc::container
