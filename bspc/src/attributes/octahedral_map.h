#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace bspc::attributes {

/// Directions as whole points (x, y, z) with |x| + |y| + |z| = half on an octahedron, which is
/// unfolded to a square of (2 half + 1)² places (Meyer and others, "On floating-point normal
/// vectors", 2010). IEEE operations in a written order.
class OctahedralMap {
 public:
  using Vector = std::array<double, 3>;
  using Point = std::array<std::int32_t, 3>;
  using Place = std::array<std::uint32_t, 2>;

  static constexpr std::uint32_t kMostHalf = std::uint32_t{1} << 23;

  explicit OctahedralMap(std::uint32_t half)
      : half_(static_cast<std::int32_t>(half)), scale_(static_cast<double>(half)) {}

  /// The place of a direction of any length, the nearest in the square; the centre for (0, 0, 0)
  /// and NaN.
  Place place(const Vector& direction) const {
    const double length =
        std::fabs(direction[0]) + std::fabs(direction[1]) + std::fabs(direction[2]);
    if (!(length > 0) || !(length <= kGreatest)) return placeOf({0, 0, half_});
    const double x = direction[0] / length;
    const double y = direction[1] / length;
    double u = x;
    double v = y;
    if (direction[2] < 0) {
      u = (1.0 - std::fabs(y)) * (x >= 0 ? 1.0 : -1.0);
      v = (1.0 - std::fabs(x)) * (y >= 0 ? 1.0 : -1.0);
    }
    return placeOf(point({nearest(u), nearest(v)}));
  }

  /// The point of a place. Places beyond the square are taken as its border.
  Point point(const Place& place) const {
    const std::int32_t u = coordinate(place[0]);
    const std::int32_t v = coordinate(place[1]);
    const std::int32_t z = half_ - magnitude(u) - magnitude(v);
    if (z >= 0) return {u, v, z};
    return {signOf(u) * (half_ - magnitude(v)), signOf(v) * (half_ - magnitude(u)), z};
  }

  /// The place of a point: where several places on the border of the square have the same point,
  /// always the same one of them.
  Place placeOf(const Point& point) const {
    std::int32_t u = point[0];
    std::int32_t v = point[1];
    if (point[2] < 0) {
      u = signOf(point[0]) * (half_ - magnitude(point[1]));
      v = signOf(point[1]) * (half_ - magnitude(point[0]));
    }
    return {static_cast<std::uint32_t>(u + half_), static_cast<std::uint32_t>(v + half_)};
  }

  /// The direction of a place, of length one but for rounding.
  Vector direction(const Place& place) const {
    const Point p = point(place);
    const auto x = static_cast<double>(p[0]);
    const auto y = static_cast<double>(p[1]);
    const auto z = static_cast<double>(p[2]);
    const double length = std::sqrt(x * x + y * y + z * z);
    return {x / length, y / length, z / length};
  }

 private:
  static constexpr double kGreatest = 0x1p1000;

  std::uint32_t nearest(double t) const {
    return static_cast<std::uint32_t>(std::floor((t + 1.0) * scale_ + 0.5));
  }
  std::int32_t coordinate(std::uint32_t place) const {
    const auto last = static_cast<std::uint32_t>(2 * half_);
    return static_cast<std::int32_t>(place < last ? place : last) - half_;
  }
  static std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }
  static std::int32_t signOf(std::int32_t v) { return v < 0 ? -1 : 1; }

  std::int32_t half_;
  double scale_;
};

/// The octahedron unfolded around the corner that a direction is next to, so that places near the
/// direction are near each other in the square too.
class OctahedralChart {
 public:
  using Vector = OctahedralMap::Vector;
  using Place = OctahedralMap::Place;

  explicit OctahedralChart(const Vector& direction) {
    for (unsigned k = 0; k < 3; ++k) {
      if (std::fabs(direction[k]) > std::fabs(direction[axes_[2]])) axes_[2] = k;
    }
    axes_[0] = (axes_[2] + 1) % 3;
    axes_[1] = (axes_[2] + 2) % 3;
    mirrored_ = direction[axes_[2]] < 0;
  }

  /// The place of a direction in the chart.
  Place place(const OctahedralMap& map, const Vector& v) const {
    const double last = v[axes_[2]];
    return map.place({v[axes_[0]], v[axes_[1]], mirrored_ ? -last : last});
  }

  /// Places of the map as places of the chart, and back.
  Place toChart(const OctahedralMap& map, const Place& place) const {
    const OctahedralMap::Point p = map.point(place);
    const std::int32_t last = p[axes_[2]];
    return map.placeOf({p[axes_[0]], p[axes_[1]], mirrored_ ? -last : last});
  }
  Place fromChart(const OctahedralMap& map, const Place& place) const {
    const OctahedralMap::Point p = map.point(place);
    OctahedralMap::Point result{};
    result[axes_[0]] = p[0];
    result[axes_[1]] = p[1];
    result[axes_[2]] = mirrored_ ? -p[2] : p[2];
    return map.placeOf(result);
  }

 private:
  std::array<unsigned, 3> axes_{0, 1, 2};
  bool mirrored_ = false;
};

}  // namespace bspc::attributes
