#pragma once

#include <cstdint>

namespace bspc::geometry {

// Integer geometry of method bsp: the decoder repeats all of it, so nothing here may depend on the
// machine. Places are in units of 2^-kFractionBits grid steps, directions in units of
// 2^-kUnitBits. For grids of up to 21 bits an axis, places stay below 2^29, squared lengths below
// 2^60 and products of places and directions below 2^46.

constexpr unsigned kFractionBits = 8;
constexpr unsigned kUnitBits = 14;
constexpr std::int64_t kOneStep = std::int64_t{1} << kFractionBits;
constexpr std::int64_t kUnit = std::int64_t{1} << kUnitBits;

struct IntegerVector {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;

  friend IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

inline std::int64_t dot(const IntegerVector& a, const IntegerVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// a / b rounded down; b > 0.
constexpr std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return a % b < 0 ? q - 1 : q;
}

/// a / b rounded to nearest, halves up; b > 0.
constexpr std::int64_t roundDivide(std::int64_t a, std::int64_t b) {
  return floorDivide(2 * a + b, 2 * b);
}

/// a / 2^bits rounded down.
constexpr std::int64_t floorShift(std::int64_t a, unsigned bits) { return a >> bits; }
static_assert(floorShift(-3, 1) == -2, "shifts of negative numbers must be arithmetic");

/// The largest r with r² ≤ v; 0 for negative v.
inline std::int64_t integerRoot(std::int64_t v) {
  std::int64_t root = 0;
  for (std::int64_t bit = std::int64_t{1} << 62; bit > 0; bit >>= 2) {
    if (v >= root + bit) {
      v -= root + bit;
      root = (root >> 1) + bit;
    } else {
      root >>= 1;
    }
  }
  return root;
}

/// The direction of `v` in units of 2^-kUnitBits; the x axis for the null vector.
inline IntegerVector direction(const IntegerVector& v) {
  const std::int64_t length = integerRoot(dot(v, v));
  if (length == 0) return {kUnit, 0, 0};
  return {roundDivide(v.x * kUnit, length), roundDivide(v.y * kUnit, length),
          roundDivide(v.z * kUnit, length)};
}

}  // namespace bspc::geometry
