#pragma once

#include <array>
#include <cstdint>

#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"

namespace bspc::connectivity {

/// Codes a number of which nothing is known: seven raw bits for its length, then its bits.
template <class Coder>
std::uint64_t codeNumber(Coder& coder, std::uint64_t value) {
  constexpr unsigned kLengthBits = 7;
  const std::uint32_t length = coder.raw(entropy::bitLength(value), kLengthBits);
  return length == 0 ? 0 : coder.wide(value, length > 64 ? 64 : length);
}

/// Codes numbers whose lengths are alike.
class AdaptiveNumber {
 public:
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t value) {
    const unsigned wanted = entropy::bitLength(value);
    unsigned length = 0;
    while (length < 64 && coder.bit(longer_[length], length < wanted)) ++length;
    if (length < 2) return length;
    const std::uint64_t top = std::uint64_t{1} << (length - 1);
    return top | coder.wide(value & (top - 1), length - 1);
  }

  template <class Coder>
  std::int64_t codeSigned(Coder& coder, std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    const std::uint64_t folded = code(coder, value < 0 ? ~(bits << 1) : bits << 1);
    const std::uint64_t half = folded >> 1;
    return static_cast<std::int64_t>((folded & 1) != 0 ? ~half : half);
  }

 private:
  std::array<entropy::AdaptiveBit, 64> longer_;
};

}  // namespace bspc::connectivity
