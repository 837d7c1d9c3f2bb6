#pragma once

#include <cstdint>
#include <limits>

namespace bspc {

/// Sums of numbers that a file claims, which can be any: they stop at the top instead of wrapping
/// round.
constexpr std::uint64_t saturatingAdd(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t sum = a + b;
  return sum < a ? std::numeric_limits<std::uint64_t>::max() : sum;
}

}  // namespace bspc
