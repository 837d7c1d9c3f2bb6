#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/span.h"

namespace bspc::entropy {

/// The inverse of RangeEncoder. Safe on any bytes: a stream that was not written by the encoder
/// gives some sequence of symbols; one that is read far past its end throws Error(Corrupt).
class RangeDecoder {
 public:
  explicit RangeDecoder(ByteView bytes);

  /// Where in [0, total) the coded part lies; to be followed by consume().
  std::uint32_t position(std::uint32_t total) {
    unit_ = range_ / total;
    const std::uint64_t at = code_ / unit_;
    return at < total ? static_cast<std::uint32_t>(at) : total - 1;
  }

  void consume(std::uint32_t start, std::uint32_t width) {
    code_ -= unit_ * start;
    range_ = unit_ * width;
    renormalise();
  }

  bool decodeBit(std::uint32_t one) {
    const std::uint64_t bound = (range_ >> 16) * one;
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    renormalise();
    return bit;
  }

  std::uint32_t decodeRaw(unsigned width) {
    range_ >>= width;
    const std::uint64_t value = code_ / range_;
    const std::uint64_t top = (std::uint64_t{1} << width) - 1;
    const std::uint64_t clamped = value < top ? value : top;
    code_ -= range_ * clamped;
    renormalise();
    return static_cast<std::uint32_t>(clamped);
  }

  /// Throws Error(Corrupt) unless every byte of the stream was used.
  void expectEnd() const;

 private:
  static constexpr unsigned kMaxMissing = 8;

  void renormalise() {
    if ((range_ >> 32) == 0) {
      range_ <<= 32;
      code_ = (code_ << 32) | nextWord();
    }
  }

  std::uint64_t nextWord() {
    if (bytes_.size() - at_ >= 4) {
      const std::uint8_t* p = bytes_.data() + at_;
      at_ += 4;
      return (std::uint64_t{p[0]} << 24) | (std::uint64_t{p[1]} << 16) |
             (std::uint64_t{p[2]} << 8) | p[3];
    }
    return lastWord();
  }
  std::uint64_t lastWord();

  ByteView bytes_;
  std::size_t at_ = 0;
  unsigned missing_ = 0;  ///< zero bytes supplied past the end
  std::uint64_t code_ = 0;
  std::uint64_t range_ = ~std::uint64_t{0};
  std::uint64_t unit_ = 0;
};

}  // namespace bspc::entropy
