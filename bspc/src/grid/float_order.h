#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

namespace bspc::lattice {

// Floating-point numbers as integers in the same order: the number of a float is its bits, all
// turned over if it is negative, else with the top bit set. −0 comes just before +0.

constexpr std::uint32_t kTop32 = std::uint32_t{1} << 31;
constexpr std::uint64_t kTop64 = std::uint64_t{1} << 63;

constexpr std::uint32_t orderOfBits(std::uint32_t bits) {
  return (bits & kTop32) != 0 ? ~bits : bits | kTop32;
}
constexpr std::uint64_t orderOfBits(std::uint64_t bits) {
  return (bits & kTop64) != 0 ? ~bits : bits | kTop64;
}
constexpr std::uint32_t bitsOfOrder(std::uint32_t order) {
  return (order & kTop32) != 0 ? order & ~kTop32 : ~order;
}
constexpr std::uint64_t bitsOfOrder(std::uint64_t order) {
  return (order & kTop64) != 0 ? order & ~kTop64 : ~order;
}

inline std::uint32_t orderOf(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return orderOfBits(bits);
}
inline std::uint64_t orderOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return orderOfBits(bits);
}
inline float floatOfOrder(std::uint32_t order) {
  const std::uint32_t bits = bitsOfOrder(order);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
inline double doubleOfOrder(std::uint64_t order) {
  const std::uint64_t bits = bitsOfOrder(order);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// The upper 32 bits of a double's number are the multiple of a grid, the lower its low half.
inline double doubleOfHalves(std::uint32_t high, std::uint32_t low) {
  return doubleOfOrder(std::uint64_t{high} << 32 | low);
}

/// The numbers of the finite floats, and the upper halves of those of the finite doubles.
struct OrderRange {
  std::uint32_t first;
  std::uint32_t last;
};
inline OrderRange finiteFloats() {
  return {orderOf(-std::numeric_limits<float>::max()), orderOf(std::numeric_limits<float>::max())};
}
inline OrderRange finiteDoubles() {
  return {static_cast<std::uint32_t>(orderOf(-std::numeric_limits<double>::max()) >> 32),
          static_cast<std::uint32_t>(orderOf(std::numeric_limits<double>::max()) >> 32)};
}

}  // namespace bspc::lattice
