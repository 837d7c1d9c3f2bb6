#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/error.h"
#include "bspc/span.h"
#include "geometry/fast/little_endian.h"

namespace bspc::geometry::fast {

/// Widest field that one step writes or reads: with the bits of a begun byte it fits 64 bits.
constexpr unsigned kMaxFieldBits = 56;

/// What must be readable behind every section, so that steps of fixed size need no care at its end.
constexpr std::size_t kSectionPadding = 128;

constexpr std::uint64_t lowBits(unsigned width) { return (std::uint64_t{1} << width) - 1; }

/// Packs unsigned fields, lowest bit first.
class BitWriter {
 public:
  static constexpr bool kWriting = true;

  /// `value` < 2^width, width ≤ kMaxFieldBits.
  void put(std::uint64_t value, unsigned width) {
    reserve(8);
    pending_ |= value << pendingBits_;
    storeLittle64(&bytes_[at_], pending_);
    pendingBits_ += width;
    at_ += pendingBits_ >> 3;
    // Shifting by 64 is not defined, and happens when eight whole bytes are done.
    pending_ = pendingBits_ == 64 ? 0 : pending_ >> (pendingBits_ & ~7U);
    pendingBits_ &= 7;
  }

  /// The `width` lowest bits of each of `count` values.
  template <class T>
  void putLowBits(const T* values, std::size_t count, unsigned width) {
    if (width == 0) return;
    const std::uint64_t mask = lowBits(width);
    for (std::size_t i = 0; i < count; ++i) put(values[i] & mask, width);
  }

  /// The shape that BitReader shares, for code that serves both directions.
  std::uint64_t code(std::uint64_t value, unsigned width) {
    put(value, width);
    return value;
  }

  std::size_t bitCount() const { return 8 * at_ + pendingBits_; }

  Bytes finish() {
    bytes_.resize(at_ + (pendingBits_ > 0 ? 1 : 0));
    return std::move(bytes_);
  }

 private:
  void reserve(std::size_t more) {
    if (bytes_.size() < at_ + more) bytes_.resize(2 * bytes_.size() + 64);
  }

  Bytes bytes_;
  std::size_t at_ = 0;
  std::uint64_t pending_ = 0;
  unsigned pendingBits_ = 0;
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

  /// Bits that were taken before.
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
