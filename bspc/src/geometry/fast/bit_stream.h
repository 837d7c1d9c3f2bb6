#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/error.h"
#include "bspc/span.h"
#include "geometry/fast/little_endian.h"

namespace bspc::geometry::fast {

/// Widest field that one step writes or reads: with the bits of a begun byte it fits 64 bits.
constexpr unsigned kMaxFieldBits = 56;

/// What must be readable behind every section, so that steps of fixed size need no care at its end,
/// and a chunk's worth of fields is looked at before it is known whether the section has them.
constexpr std::size_t kSectionPadding = 320;

constexpr std::uint64_t lowBits(unsigned width) { return (std::uint64_t{1} << width) - 1; }

/// Packs unsigned fields, lowest bit first.
class BitWriter {
 public:
  static constexpr bool kWriting = true;

  /// `value` < 2^width, width ≤ kMaxFieldBits.
  void put(std::uint64_t value, unsigned width) {
    reserve(8);
    Place place = place_;
    append(place, bytes_.data(), value, width);
    place_ = place;
  }

  /// Puts `count` fields; field(i, width) returns the value of the i-th and sets its width.
  template <class Field>
  void putEach(std::size_t count, const Field& field) {
    reserve(8 * count);
    std::uint8_t* bytes = bytes_.data();
    Place place = place_;
    for (std::size_t i = 0; i < count; ++i) {
      unsigned width = 0;
      const std::uint64_t value = field(i, width);
      append(place, bytes, value, width);
    }
    place_ = place;
  }

  /// The `width` lowest bits of each of `count` values.
  template <class T>
  void putLowBits(const T* values, std::size_t count, unsigned width) {
    if (width == 0) return;
    const std::uint64_t mask = lowBits(width);
    putEach(count, [=](std::size_t i, unsigned& fieldWidth) {
      fieldWidth = width;
      return std::uint64_t{values[i] & mask};
    });
  }

  /// The shape that BitReader shares, for code that serves both directions.
  std::uint64_t code(std::uint64_t value, unsigned width) {
    put(value, width);
    return value;
  }

  std::size_t bitCount() const { return 8 * place_.at + place_.pendingBits; }

  Bytes finish() {
    bytes_.resize(place_.at + (place_.pendingBits > 0 ? 1 : 0));
    return std::move(bytes_);
  }

 private:
  /// Where the next bit goes. Loops keep it in registers, which members cannot be: bytes that are
  /// written could be theirs.
  struct Place {
    std::size_t at = 0;
    std::uint64_t pending = 0;
    unsigned pendingBits = 0;
  };

  static void append(Place& place, std::uint8_t* bytes, std::uint64_t value, unsigned width) {
    place.pending |= value << place.pendingBits;
    storeLittle64(bytes + place.at, place.pending);
    place.pendingBits += width;
    place.at += place.pendingBits >> 3;
    // Shifting by 64 is not defined, and happens when eight whole bytes are done.
    place.pending = place.pendingBits == 64 ? 0 : place.pending >> (place.pendingBits & ~7U);
    place.pendingBits &= 7;
  }

  void reserve(std::size_t more) {
    if (bytes_.size() < place_.at + more) bytes_.resize(2 * bytes_.size() + more + 64);
  }

  Bytes bytes_;
  Place place_;
};

/// Reads what BitWriter packed. kSectionPadding bytes behind the section must be readable.
class BitReader {
 public:
  static constexpr bool kWriting = false;

  BitReader() = default;
  BitReader(const std::uint8_t* data, std::size_t size) : data_(data), bits_(8 * size) {}

  /// The next `width` ≤ kMaxFieldBits bits; throws Error(Corrupt) past the end.
  std::uint64_t get(unsigned width) {
    const std::size_t from = advance(width);
    return at(from, width);
  }
  std::uint64_t code(std::uint64_t /*value*/, unsigned width) { return get(width); }

  /// Takes `count` bits, to be looked at with at(), and returns the position of the first.
  std::size_t advance(std::size_t count) {
    if (count > bits_ - at_) fail();
    at_ += count;
    return at_ - count;
  }

  /// Of the next bit.
  std::size_t position() const { return at_; }

  /// Bits that were taken before, or that are taken at once.
  std::uint64_t at(std::size_t position, unsigned width) const {
    return (loadLittle64(data_ + (position >> 3)) >> (position & 7)) & lowBits(width);
  }

  /// Throws Error(Corrupt) unless everything was read but the zero bits that fill the last byte.
  void expectEnd() {
    if (bits_ - at_ >= 8 || get(static_cast<unsigned>(bits_ - at_)) != 0) {
      throw Error(ErrorCode::Corrupt, "a section of raw bits goes on after its last field");
    }
  }

 private:
  [[noreturn]] static void fail() {
    throw Error(ErrorCode::Corrupt,
                "a section of raw bits ends before its last field: the file is damaged");
  }

  const std::uint8_t* data_ = nullptr;
  std::size_t bits_ = 0;
  std::size_t at_ = 0;
};

}  // namespace bspc::geometry::fast
