#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "grid/axis_map.h"

namespace bspc::lattice {

/// How an axis turns multiples into coordinates: k / denominator, k · numerator / denominator, or
/// origin + k · step.
enum class AxisForm { Fraction, Ratio, Affine };

/// What AxisMaps of floating-point coordinates compute, their case settled outside of the loops, so
/// that compilers make several numbers at once. The results are those of the maps, bit for bit: a
/// numerator of one can be left out, for multiplying and dividing by it change nothing. Lanes are
/// axes by turns, as coordinates of points stand in memory, or a single one.
template <AxisForm Form, class Scalar, std::size_t Lanes = 1>
class AxisKernel {
 public:
  template <std::size_t Axes>
  explicit AxisKernel(const std::array<AxisMap, Axes>& maps) {
    for (std::size_t i = 0; i < Lanes; ++i) {
      numerator_[i] = maps[i % Axes].numerator();
      denominator_[i] = maps[i % Axes].denominator();
      origin_[i] = maps[i % Axes].origin();
      step_[i] = maps[i % Axes].step();
    }
  }

  double quotient(double value, std::size_t lane = 0) const {
    if constexpr (Form == AxisForm::Fraction) return value * denominator_[lane];
    if constexpr (Form == AxisForm::Ratio) return (value * denominator_[lane]) / numerator_[lane];
    return (value - origin_[lane]) / step_[lane];
  }
  /// Of a multiple whose coordinate fits.
  Scalar restored(double multiple, std::size_t lane = 0) const {
    return static_cast<Scalar>(coordinate(multiple, lane)) + Scalar{0};
  }
  /// Whether the coordinates of multiples with 32 bits, ±2^31 aside, need no clamping.
  bool fits() const {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    constexpr double kGreatest = std::numeric_limits<Scalar>::max();
    for (std::size_t i = 0; i < Lanes; ++i) {  // what lies between two that fit does, too
      if (!(std::fabs(coordinate(kMost, i)) <= kGreatest)) return false;
      if (!(std::fabs(coordinate(-kMost, i)) <= kGreatest)) return false;
    }
    return true;
  }

 private:
  using Numbers = std::array<double, Lanes>;

  double coordinate(double multiple, std::size_t lane) const {
    if constexpr (Form == AxisForm::Fraction) return multiple / denominator_[lane];
    if constexpr (Form == AxisForm::Ratio) {
      return (multiple * numerator_[lane]) / denominator_[lane];
    }
    return origin_[lane] + multiple * step_[lane];
  }

  Numbers numerator_;
  Numbers denominator_;
  Numbers origin_;
  Numbers step_;
};

template <AxisForm Form, class Scalar, std::size_t Lanes, std::size_t Axes, class Visit>
bool withKernelOf(const std::array<AxisMap, Axes>& maps, Visit visit) {
  const AxisKernel<Form, Scalar, Lanes> kernel(maps);
  return kernel.fits() && visit(kernel);
}

template <AxisForm Form, std::size_t Lanes, std::size_t Axes, class Visit>
bool withKernelOfForm(const std::array<AxisMap, Axes>& maps, Visit visit) {
  if (maps[0].type() == ScalarType::Float32) return withKernelOf<Form, float, Lanes>(maps, visit);
  return withKernelOf<Form, double, Lanes>(maps, visit);
}

/// What visit(kernel) returns, of a kernel for axes of one grid; false without a call if there is
/// none, as coordinates are integers or some multiples of 32 bits have none.
template <std::size_t Lanes, std::size_t Axes, class Visit>
bool withKernel(const std::array<AxisMap, Axes>& maps, Visit visit) {
  if (!isFloatingPoint(maps[0].type())) return false;
  if (!maps[0].isRational()) return withKernelOfForm<AxisForm::Affine, Lanes>(maps, visit);
  for (const AxisMap& map : maps) {
    if (map.numerator() != 1) return withKernelOfForm<AxisForm::Ratio, Lanes>(maps, visit);
  }
  return withKernelOfForm<AxisForm::Fraction, Lanes>(maps, visit);
}

/// The same for one axis.
template <class Visit>
bool withKernel(const AxisMap& map, Visit visit) {
  return withKernel<1>(std::array<AxisMap, 1>{map}, visit);
}

/// nearestInteger(kernel.quotient(value)) of `count` values, at most N. False if some are too large
/// for 32 bits, which processors convert several of at once, unlike 64.
template <std::size_t N, class Kernel>
bool nearestMultiples(const Kernel& kernel, const double* values, std::size_t count,
                      std::array<std::int32_t, N>& multiples) {
  constexpr double kMost = 2147483647.0;  // exclusive, as rounding can add a half
  std::array<double, N> quotients;
  std::uint64_t beyond = 0;  // as wide as the numbers, so that they are compared together
  for (std::size_t i = 0; i < count; ++i) {
    const double quotient = kernel.quotient(values[i]);
    quotients[i] = quotient;
    beyond |= std::fabs(quotient) < kMost ? 0U : 1U;  // NaN is beyond, too
  }
  if (beyond != 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const double half = quotients[i] < 0 ? -0.5 : 0.5;
    multiples[i] = static_cast<std::int32_t>(quotients[i] + half);
  }
  return true;
}

}  // namespace bspc::lattice
