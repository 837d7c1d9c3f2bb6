#pragma once

#include <array>
#include <cstdint>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"

namespace bspc::geometry {

/// Codes how many equal points beyond the fewest a grid position holds: the length of the number
/// plus one in unary with learned bits, then its lower bits raw.
class MultiplicityModel {
 public:
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t more) {
    const unsigned wanted = entropy::bitLength(more + 1) - 1;
    unsigned length = 0;
    while (coder.bit(longer_[length], length < wanted)) {
      if (++length == kMaxLength) {
        throw Error(ErrorCode::Corrupt, "a grid position with more points than a tile can hold");
      }
    }
    const std::uint64_t top = std::uint64_t{1} << length;
    return (top | coder.wide((more + 1) & (top - 1), length)) - 1;
  }

 private:
  static constexpr unsigned kMaxLength = 34;
  std::array<entropy::AdaptiveBit, kMaxLength> longer_{};
};

}  // namespace bspc::geometry
