#pragma once

#include <cstdint>

#include "bspc/span.h"

namespace bspc::entropy {

/// Range encoder with 64-bit low and range and 32-bit renormalisation (docs/format.md, "Range
/// coder"; the principle is Martin's, 1979). Carries run back into the bytes already written.
class RangeEncoder {
 public:
  /// Codes the part [start, start + width) of a whole of `total` < 2^32.
  void encode(std::uint32_t start, std::uint32_t width, std::uint32_t total) {
    const std::uint64_t unit = range_ / total;
    advance(unit * start);
    range_ = unit * width;
    renormalise();
  }

  /// Codes a bit whose probability of being 1 is `one` / 2^16.
  void encodeBit(bool bit, std::uint32_t one) {
    const std::uint64_t bound = (range_ >> 16) * one;
    if (bit) {
      range_ = bound;
    } else {
      advance(bound);
      range_ -= bound;
    }
    renormalise();
  }

  /// Codes `width` ≤ 24 equally likely bits.
  void encodeRaw(std::uint32_t value, unsigned width) {
    range_ >>= width;
    advance(range_ * value);
    renormalise();
  }

  /// Ends the stream and returns it. Zero bytes among its last eight are left
  /// out: the decoder supplies them.
  Bytes finish();

 private:
  void advance(std::uint64_t step) {
    low_ += step;
    if (low_ < step) carry();
  }

  void renormalise() {
    if ((range_ >> 32) == 0) {
      emitWord();
      range_ <<= 32;
    }
  }

  void carry();
  void emitWord();

  std::uint64_t low_ = 0;
  std::uint64_t range_ = ~std::uint64_t{0};
  Bytes out_;
};

}  // namespace bspc::entropy
