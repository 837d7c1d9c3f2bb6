#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace bspc {

/// An odd factor for hash tables whose keys a file chooses, another one in each process: with one
/// that is known, keys that all fall on the same place could be put into a file, and each would
/// take as long as all before it. Nothing that is found in a table may depend on it.
inline std::uint64_t hashMultiplier() {
  static const std::uint64_t multiplier = [] {
    std::random_device random;
    return (std::uint64_t{random()} << 32 | random()) | 1U;
  }();
  return multiplier;
}

/// The place of a key in a table of 2^bits, bits ≥ 1.
inline std::size_t hashPlace(std::uint64_t key, std::uint64_t multiplier, unsigned bits) {
  return static_cast<std::size_t>((key * multiplier) >> (64 - bits));
}

}  // namespace bspc
