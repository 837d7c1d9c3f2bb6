#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "entropy/symbol_coder.h"

namespace bspc::geometry::fast {

/// Points of a slab that share a surface and one set of classes.
constexpr std::size_t kChunkPoints = 40;

/// How the heights of a chunk are predicted.
enum class SurfaceMode : std::uint8_t { Constant = 0, Plane = 1, Quadric = 2, Delta = 3 };

constexpr unsigned kNormalBits = 12;  ///< of coordinates relative to a chunk's centre
constexpr std::uint32_t kFilter1 = 45;
constexpr std::uint32_t kFilter2 = 26;  ///< weights of the last two residuals, in 1/128

/// Signed shifts by a signed number of places, modulo 2^64; to the right rounding down.
inline std::int64_t shifted(std::int64_t value, int left) {
  if (left >= 0) return static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << left);
  return value >> -left;
}

/// Middle of a chunk's (u, v) and bits of its half sides.
struct Footprint {
  std::uint32_t centre[2] = {};
  int halfBits[2] = {};

  static Footprint of(const std::uint32_t* u, const std::uint32_t* v, std::size_t count) {
    Footprint f;
    f.along(0, u, count);
    f.along(1, v, count);
    return f;
  }
  /// (c − centre) scaled so that the half side takes kNormalBits.
  std::int32_t normal(unsigned axis, std::uint32_t c) const {
    const auto d = static_cast<std::int32_t>(c - centre[axis]);
    const int grow = static_cast<int>(kNormalBits) - halfBits[axis];
    return grow >= 0 ? static_cast<std::int32_t>(static_cast<std::uint32_t>(d) << grow)
                     : d >> -grow;
  }

 private:
  void along(unsigned axis, const std::uint32_t* c, std::size_t count) {
    std::uint32_t low = c[0];
    std::uint32_t high = c[0];
    for (std::size_t i = 1; i < count; ++i) {
      low = std::min(low, c[i]);
      high = std::max(high, c[i]);
    }
    centre[axis] = low + (high - low) / 2;
    halfBits[axis] = static_cast<int>(entropy::bitLength(high - centre[axis]));
  }
};

/// Quantised height function of a chunk. Heights are told in eighths of a step; all parameters in
/// units of 2^precision of them, the coarser the larger the residuals are.
struct Surface {
  SurfaceMode mode = SurfaceMode::Delta;
  int precision = 0;
  std::int64_t height = 0;     ///< at the centre
  std::int64_t slope[2] = {};  ///< half the rise from the centre to the edge
  std::int64_t bend[3] = {};   ///< a quarter of the coefficients of X², XY, Y²
};

/// Step of a surface's parameters that suits residuals of a class.
constexpr int precisionOf(unsigned residualClass) {
  return static_cast<int>(residualClass >> 1) + 2;
}

/// Heights of the surface at normalised positions, modulo 2^32.
inline void evaluate(const Surface& surface, const std::int32_t* x, const std::int32_t* y,
                     std::size_t count, std::uint32_t* heights) {
  const auto word = [](std::int64_t v) { return static_cast<std::uint32_t>(v); };
  const std::uint32_t base = word(surface.height) << surface.precision;
  const auto floorEighth = [](std::uint32_t v) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(v) >> 3);
  };
  if (surface.mode == SurfaceMode::Constant) {
    std::fill(heights, heights + count, floorEighth(base));
    return;
  }
  const std::uint32_t a = word(surface.slope[0]);
  const std::uint32_t b = word(surface.slope[1]);
  const std::uint32_t c = word(surface.bend[0]);
  const std::uint32_t d = word(surface.bend[1]);
  const std::uint32_t e = word(surface.bend[2]);
  const int right = std::max(static_cast<int>(kNormalBits) - 1 - surface.precision, 0);
  const int left = std::max(surface.precision + 1 - static_cast<int>(kNormalBits), 0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto square = [](std::int32_t p) { return static_cast<std::uint32_t>(p >> kNormalBits); };
    const std::uint32_t sum =
        a * static_cast<std::uint32_t>(x[i]) + b * static_cast<std::uint32_t>(y[i]) +
        2U * (c * square(x[i] * x[i]) + d * square(x[i] * y[i]) + e * square(y[i] * y[i]));
    const auto rise = static_cast<std::uint32_t>(static_cast<std::int32_t>(sum) >> right) << left;
    heights[i] = floorEighth(base + rise);
  }
}

/// What the residual of a point is expected to be after the two before it.
inline std::uint32_t filtered(std::uint32_t last, std::uint32_t beforeLast) {
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(kFilter1 * last + kFilter2 * beforeLast + 64U) >> 7);
}

/// The surface of the chunk before, from which that of the next one is predicted. Height and slopes
/// in 2^-16 steps.
class SurfaceHistory {
 public:
  /// For the first chunk of a slab: level, in the middle of its height.
  SurfaceHistory(std::uint32_t u, std::uint32_t v, std::uint32_t height) { level(u, v, height); }

  /// Height and slopes to be expected in a footprint, in the units of a precision.
  Surface expected(const Footprint& at, int precision) const {
    Surface s;
    s.precision = precision;
    std::uint64_t height = static_cast<std::uint64_t>(height_);
    for (unsigned k = 0; k < 2; ++k) {
      const std::int64_t moved =
          static_cast<std::int64_t>(at.centre[k]) - static_cast<std::int64_t>(centre_[k]);
      height += static_cast<std::uint64_t>(slope_[k]) * static_cast<std::uint64_t>(moved);
      s.slope[k] = limited(shifted(slope_[k], at.halfBits[k] - 14 - precision));
    }
    s.height = limited(static_cast<std::int64_t>(height) >> (13 + precision));
    return s;
  }

  void remember(const Footprint& at, const Surface& s) {
    height_ = shifted(s.height, s.precision + 13);
    for (unsigned k = 0; k < 2; ++k) {
      slope_[k] = shifted(s.slope[k], 14 + s.precision - at.halfBits[k]);
      centre_[k] = at.centre[k];
    }
  }
  /// After a chunk without a surface: the slopes stay, through its last point.
  void passThrough(std::uint32_t u, std::uint32_t v, std::uint32_t height) {
    height_ = static_cast<std::int64_t>(height) << 16;
    centre_[0] = u;
    centre_[1] = v;
  }

 private:
  static constexpr std::int64_t kLimit = std::int64_t{1} << 30;
  static std::int64_t limited(std::int64_t v) { return std::clamp(v, -kLimit, kLimit); }

  void level(std::uint32_t u, std::uint32_t v, std::uint32_t height) {
    slope_[0] = slope_[1] = 0;
    passThrough(u, v, height);
  }

  std::int64_t height_ = 0;
  std::int64_t slope_[2] = {};
  std::uint32_t centre_[2] = {};
};

}  // namespace bspc::geometry::fast
