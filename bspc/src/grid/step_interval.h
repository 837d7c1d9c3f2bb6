#pragma once

#include <cstddef>
#include <vector>

#include "bspc/scalar_type.h"

namespace bspc::lattice {

/// The steps that are possible still.
struct StepInterval {
  double low = 0;
  double high = 0;

  bool empty() const { return !(low <= high); }
  double middle() const { return low + (high - low) / 2; }
  bool contains(double step) const { return low <= step && step <= high; }
};

/// How far a coordinate may be from its lattice point: half the spacing of its type at `value`,
/// and the rounding of the multiple of the step in double, which is at most `largest`.
double roundingNoise(ScalarType type, double value, double largest);

/// Steps, coarsest first, at least `finest`, for which the differences of the values (sorted,
/// distinct, each within `noise` of its lattice point) are all near multiples; where the lattice
/// starts plays no part. Empty if there are none; usually found out within the first few values.
std::vector<StepInterval> stepsOfSample(const std::vector<double>& values, double noise,
                                        double finest);

/// Numbers within the interval to try as the step: those short to write first.
std::vector<double> stepCandidates(const StepInterval& interval);

/// The decimal number of at most six digits within the interval that has the fewest; 0 if none.
double shortDecimal(const StepInterval& interval);

}  // namespace bspc::lattice
