#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace bspc::attributes {

/// Directions as places on an octahedron that is unfolded to a square of (2^bits − 1)² places
/// (Meyer and others, "On floating-point normal vectors", 2010). IEEE operations in a written
/// order.
class OctahedralMap {
 public:
  using Vector = std::array<double, 3>;
  using Place = std::array<std::uint32_t, 2>;

  static constexpr unsigned kMinBits = 2;
  static constexpr unsigned kMaxBits = 24;

  explicit OctahedralMap(unsigned bits)
      : half_((std::uint32_t{1} << (bits - 1)) - 1), centre_(static_cast<double>(half_)) {}

  /// The place nearest to a direction of any length; the centre for (0, 0, 0) and NaN.
  Place place(const Vector& direction) const {
    const double length =
        std::fabs(direction[0]) + std::fabs(direction[1]) + std::fabs(direction[2]);
    if (!(length > 0) || !(length <= kGreatest)) return {half_, half_};
    const double x = direction[0] / length;
    const double y = direction[1] / length;
    double u = x;
    double v = y;
    if (direction[2] < 0) {
      u = (1.0 - std::fabs(y)) * (x >= 0 ? 1.0 : -1.0);
      v = (1.0 - std::fabs(x)) * (y >= 0 ? 1.0 : -1.0);
    }
    return {nearest(u), nearest(v)};
  }

  /// The direction of a place, of length one but for rounding. Places beyond the square are taken
  /// as its border.
  Vector direction(const Place& place) const {
    double x = coordinate(place[0]);
    double y = coordinate(place[1]);
    const double z = 1.0 - std::fabs(x) - std::fabs(y);
    if (z < 0) {
      const double u = (1.0 - std::fabs(y)) * (x >= 0 ? 1.0 : -1.0);
      const double v = (1.0 - std::fabs(x)) * (y >= 0 ? 1.0 : -1.0);
      x = u;
      y = v;
    }
    const double length = std::sqrt(x * x + y * y + z * z);
    return {x / length, y / length, z / length};
  }

 private:
  static constexpr double kGreatest = 0x1p1000;

  std::uint32_t nearest(double t) const {
    return static_cast<std::uint32_t>(std::floor((t + 1.0) * centre_ + 0.5));
  }
  double coordinate(std::uint32_t place) const {
    const std::uint32_t last = 2 * half_;
    return static_cast<double>(place < last ? place : last) / centre_ - 1.0;
  }

  std::uint32_t half_;
  double centre_;
};

}  // namespace bspc::attributes
