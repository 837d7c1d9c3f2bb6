#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace bspc::geometry::predictive {

/// A camera that looks along an axis of the grid: the point of depth z in pixel (u, v) stands at
/// x = (u + c_x) · (z + z_0) / f_x − x_0, y alike, rounded. All parameters are whole numbers, so
/// that encoder and decoder compute the same from them.
struct PinholeCamera {
  unsigned depthAxis = 2;
  std::array<std::int64_t, 2> pitch{};   ///< 1 / f: pixel width a step of depth, in 2^-40
  std::int64_t depthOffset = 0;          ///< z_0 in 2^-16
  std::array<std::int64_t, 2> offset{};  ///< x_0, y_0 in 2^-16
  std::array<std::int64_t, 2> centre{};  ///< c_x, c_y in 2^-16

  static constexpr unsigned kParameterBits = 52;  ///< of pitch, depthOffset, offset, with the sign
  static constexpr unsigned kCentreBits = 18;
  static constexpr double kPitchUnit = 1099511627776.0;
  static constexpr double kUnit = 65536.0;

  /// The true depth of points may lie between two steps: in 1/32 of a step from there.
  static constexpr int kMaxShift = 20;
  static constexpr double kShiftUnit = 32.0;

  /// The other axes of the grid.
  unsigned axis(unsigned k) const { return (depthAxis + 1 + k) % 3; }

  /// Width (k = 0) or height (k = 1) of a pixel at that depth, in grid steps.
  double pixelSize(unsigned k, std::uint32_t depth, int shift) const {
    const double z = static_cast<double>(depth) + static_cast<double>(depthOffset) / kUnit +
                     static_cast<double>(shift) / kShiftUnit;
    return z * (static_cast<double>(pitch[k]) / kPitchUnit);
  }

  /// The grid coordinate along axis(k) of a pixel's centre, a whole number.
  double position(unsigned k, std::int32_t pixel, double size) const {
    const double p = static_cast<double>(pixel) + static_cast<double>(centre[k]) / kUnit;
    return std::floor(p * size - static_cast<double>(offset[k]) / kUnit + 0.5);
  }

  /// The pixel that a grid coordinate lies in; encoder only.
  double pixelAt(unsigned k, std::uint32_t coordinate, double size) const {
    const double x = static_cast<double>(coordinate) + static_cast<double>(offset[k]) / kUnit;
    return std::floor(x / size - static_cast<double>(centre[k]) / kUnit + 0.5);
  }
};

}  // namespace bspc::geometry::predictive
