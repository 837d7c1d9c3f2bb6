#pragma once

#include <cstdint>

#include "entropy/adaptive_bit.h"
#include "entropy/adaptive_symbols.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"

namespace bspc::entropy {

// A coding method is written once and driven by one of two coder objects of the same shape:
// SymbolWriter codes the value that it is given and returns it, SymbolReader ignores the value and
// returns the one that was coded. So encoder and decoder cannot drift apart.

/// The number of bits that `value` takes; 0 for 0.
constexpr unsigned bitLength(std::uint64_t value) {
  return value == 0 ? 0 : 64U - static_cast<unsigned>(__builtin_clzll(value));
}

namespace detail {

constexpr unsigned kRawBitsAtOnce = 24;

/// Codes value ≤ last as one of equally likely values, through the two primitives of `coder`.
template <class Coder>
std::uint32_t uniform(Coder& coder, std::uint32_t value, std::uint32_t last) {
  if (last < (1U << 16)) return last == 0 ? 0 : coder.slice(value, last + 1);
  // The leading 16 bits in one part, the rest raw; the last slice may be narrower.
  const unsigned shift = bitLength(last) - 16;
  const std::uint32_t high = coder.slice(value >> shift, (last >> shift) + 1);
  const std::uint32_t mask = (1U << shift) - 1;
  const std::uint32_t low = high == (last >> shift) ? uniform(coder, value & mask, last & mask)
                                                    : coder.raw(value & mask, shift);
  return (high << shift) | low;
}

/// Codes `width` ≤ 64 raw bits, most significant first.
template <class Coder>
std::uint64_t wide(Coder& coder, std::uint64_t value, unsigned width) {
  std::uint64_t result = 0;
  while (width > kRawBitsAtOnce) {
    width -= kRawBitsAtOnce;
    const auto part = static_cast<std::uint32_t>((value >> width) & ((1U << kRawBitsAtOnce) - 1));
    result = (result << kRawBitsAtOnce) | coder.raw(part, kRawBitsAtOnce);
  }
  const auto rest = static_cast<std::uint32_t>(value & ((1U << width) - 1));
  return (result << width) | coder.raw(rest, width);
}

}  // namespace detail

/// Writes symbols to a range coded stream.
class SymbolWriter {
 public:
  static constexpr bool kWriting = true;

  bool bit(AdaptiveBit& model, bool value) {
    encoder_.encodeBit(value, model.probabilityOfOne());
    model.update(value);
    return value;
  }
  /// A bit whose probability of being 1 is `one` / 2^16, 0 < one < 2^16.
  bool fixedBit(std::uint32_t one, bool value) {
    encoder_.encodeBit(value, one);
    return value;
  }
  /// A symbol of an AdaptiveSymbols or GaussianSymbols.
  template <class Model>
  unsigned symbol(Model& model, unsigned value) {
    encoder_.encode(model.cumulative(value), model.frequency(value), model.total());
    model.update(value);
    return value;
  }
  /// One of `total` ≤ 2^16 equally likely values.
  std::uint32_t slice(std::uint32_t value, std::uint32_t total) {
    encoder_.encode(value, 1, total);
    return value;
  }
  /// `width` ≤ 24 equally likely bits.
  std::uint32_t raw(std::uint32_t value, unsigned width) {
    encoder_.encodeRaw(value, width);
    return value;
  }
  /// One of the equally likely values 0 … last.
  std::uint32_t uniform(std::uint32_t value, std::uint32_t last) {
    return detail::uniform(*this, value, last);
  }
  /// `width` ≤ 64 equally likely bits.
  std::uint64_t wide(std::uint64_t value, unsigned width) {
    return detail::wide(*this, value, width);
  }

  Bytes finish() { return encoder_.finish(); }

 private:
  RangeEncoder encoder_;
};

/// Reads symbols from a range coded stream; the same calls as SymbolWriter, values ignored.
class SymbolReader {
 public:
  static constexpr bool kWriting = false;

  explicit SymbolReader(ByteView bytes) : decoder_(bytes) {}

  bool bit(AdaptiveBit& model, bool /*value*/) {
    const bool value = decoder_.decodeBit(model.probabilityOfOne());
    model.update(value);
    return value;
  }
  bool fixedBit(std::uint32_t one, bool /*value*/) { return decoder_.decodeBit(one); }
  template <class Model>
  unsigned symbol(Model& model, unsigned /*value*/) {
    std::uint32_t start = 0;
    const unsigned value = model.find(decoder_.position(model.total()), start);
    decoder_.consume(start, model.frequency(value));
    model.update(value);
    return value;
  }
  std::uint32_t slice(std::uint32_t /*value*/, std::uint32_t total) {
    const std::uint32_t value = decoder_.position(total);
    decoder_.consume(value, 1);
    return value;
  }
  std::uint32_t raw(std::uint32_t /*value*/, unsigned width) { return decoder_.decodeRaw(width); }
  std::uint32_t uniform(std::uint32_t value, std::uint32_t last) {
    return detail::uniform(*this, value, last);
  }
  std::uint64_t wide(std::uint64_t value, unsigned width) {
    return detail::wide(*this, value, width);
  }

  /// Throws Error(Corrupt) unless the stream was used up.
  void finish() const { decoder_.expectEnd(); }

 private:
  RangeDecoder decoder_;
};

}  // namespace bspc::entropy
