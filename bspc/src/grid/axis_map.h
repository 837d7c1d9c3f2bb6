#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "bspc/grid.h"

namespace bspc::lattice {

/// Multiples beyond this are not all doubles; grids that are fitted stay within it.
constexpr double kMaxMultiple = 9007199254740992.0;  // 2^53
/// Greatest index along an axis.
constexpr double kMaxIndex = 4294967295.0;

/// The least and the greatest value of an integer type, as doubles.
struct IntegerLimits {
  double min;
  double max;
};
IntegerLimits integerLimits(ScalarType type);

/// The nearest float; finite values beyond the floats become the largest one, since a conversion
/// out of range is undefined.
inline float nearestFloat(double x) {
  constexpr double kMax = std::numeric_limits<float>::max();
  return static_cast<float>(std::max(-kMax, std::min(kMax, x)));
}

/// The nearest integer, halves away from zero, as std::round() but without a call of the library.
inline double roundHalfAway(double x) {
  constexpr double kWhole = 4503599627370496.0;  // 2^52: doubles from there on are whole
  if (!(std::fabs(x) < kWhole)) return x;
  const auto whole = static_cast<double>(static_cast<std::int64_t>(x));
  const double rest = x - whole;  // exact
  if (rest >= 0.5) return whole + 1;
  return rest <= -0.5 ? whole - 1 : whole;
}

/// `x` as the nearest number of `type`, and −0 as +0.
inline double roundToScalar(ScalarType type, double x) {
  if (type == ScalarType::Float32) return double{nearestFloat(x)} + 0.0;
  if (type == ScalarType::Float64) return x + 0.0;
  const IntegerLimits limits = integerLimits(type);
  return std::max(limits.min, std::min(limits.max, roundHalfAway(x))) + 0.0;
}

/// The integer nearest to `x`, which must be within ±2^53.
inline double nearestInteger(double x) {
  return static_cast<double>(static_cast<std::int64_t>(x < 0 ? x - 0.5 : x + 0.5));
}

/// One axis of a grid, its numbers converted once for use in loops. Multiples are doubles that
/// hold integers within ±2^53.
class AxisMap {
 public:
  AxisMap(const Grid& grid, std::size_t axis)
      : rational_(grid.form == Grid::Form::Rational),
        type_(grid.scalarType),
        numerator_(static_cast<double>(grid.axes[axis].numerator)),
        denominator_(static_cast<double>(grid.axes[axis].denominator)),
        origin_(grid.axes[axis].origin),
        step_(rational_ ? numerator_ / denominator_ : grid.axes[axis].step),
        isWhole_(rational_ && grid.axes[axis].numerator == 1 && grid.axes[axis].denominator == 1),
        isIdentity_(isWhole_ && !isFloatingPoint(type_)) {}

  /// Whether multiples are coordinates themselves.
  bool isWhole() const { return isWhole_; }
  /// Whether, besides, all coordinates are integers by their type.
  bool isIdentity() const { return isIdentity_; }

  double coordinate(double multiple) const {
    return rational_ ? (multiple * numerator_) / denominator_ : origin_ + multiple * step_;
  }
  double restored(double multiple) const { return roundToScalar(type_, coordinate(multiple)); }
  double step() const { return step_; }

  bool isRational() const { return rational_; }
  ScalarType type() const { return type_; }
  double numerator() const { return numerator_; }
  double denominator() const { return denominator_; }
  double origin() const { return origin_; }

  /// Where `value` lies in steps; infinite or NaN where doubles overflow.
  double quotient(double value) const {
    return rational_ ? (value * denominator_) / numerator_ : (value - origin_) / step_;
  }
  /// Whether `value` is within the multiples that a fitted grid may use.
  bool reaches(double value) const { return std::fabs(quotient(value)) < kMaxMultiple; }

  /// The multiple whose restored coordinate is nearest to a value that the axis reaches, and how
  /// far that is.
  struct Snapped {
    double multiple;
    double error;
  };
  Snapped snap(double value) const {
    if (isIdentity_) return {value, 0};
    const double multiple = nearestInteger(quotient(value));
    const Snapped snapped{multiple, std::fabs(restored(multiple) - value)};
    // Rounding, of the quotient or to the scalar type, can favour a neighbour only near the
    // middle; an overflowing coordinate lands here too, its error being infinite.
    if (snapped.error > 0.499 * step_) return betterNeighbour(snapped, value);
    return snapped;
  }

 private:
  Snapped betterNeighbour(Snapped best, double value) const {
    for (const double other : {best.multiple - 1, best.multiple + 1}) {
      const double error = std::fabs(restored(other) - value);
      if (error < best.error) best = {other, error};
    }
    return best;
  }

  bool rational_;
  ScalarType type_;
  double numerator_;
  double denominator_;
  double origin_;
  double step_;
  bool isWhole_;
  bool isIdentity_;
};

}  // namespace bspc::lattice
