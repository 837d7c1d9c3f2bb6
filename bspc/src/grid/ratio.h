#pragma once

#include <cstdint>
#include <optional>

#include "bspc/grid.h"

namespace bspc::lattice {

/// A positive step as numerator / denominator · 2^exponent, both odd and without common factor:
/// steps of any magnitude can be compared and combined without rounding.
struct Ratio {
  std::uint64_t numerator = 1;
  std::uint64_t denominator = 1;
  int exponent = 0;

  double value() const;
  bool operator==(const Ratio& other) const {
    return numerator == other.numerator && denominator == other.denominator &&
           exponent == other.exponent;
  }
};

/// numerator / denominator · 2^exponent in lowest terms; both are above zero.
Ratio makeRatio(std::uint64_t numerator, std::uint64_t denominator, int exponent = 0);

/// The coarsest step that divides both; nothing if its terms reach 2^53.
std::optional<Ratio> commonDivisor(const Ratio& a, const Ratio& b);

/// The step of the shortest decimal number that reads as `value`; nothing if its terms reach 2^53.
std::optional<Ratio> decimalRatio(double value);

/// Sets the rational step of `axis`; false if its terms do not fit a grid.
bool setRational(Grid::Axis& axis, const Ratio& ratio);

/// A grid with this step along all axes: rational where it fits, else affine from zero.
Grid gridOf(ScalarType type, const Ratio& ratio);

}  // namespace bspc::lattice
