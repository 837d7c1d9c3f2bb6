#include "grid/step_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "bspc/error.h"
#include "grid/axis_map.h"
#include "grid/lattice.h"
#include "grid/ratio.h"

namespace bspc::lattice {

namespace {

/// The exponent of the default step.
int defaultExponent(ScalarType type, const Ranges& ranges) {
  double maxAbs = 0;
  double extent = 0;
  for (const AxisRange& range : ranges) {
    if (range.constant()) continue;
    maxAbs = std::max(maxAbs, range.maxAbs());
    extent = std::max(extent, range.extent());
  }
  // Never finer than the spacing of the numbers: with it they are exact already.
  const int spacing = spacingExponent(type, maxAbs);
  if (type == ScalarType::Float32) return spacing;
  int exponent = 0;
  if (std::isfinite(extent)) {
    std::frexp(extent, &exponent);  // extent < 2^exponent
  } else {
    exponent = std::numeric_limits<double>::max_exponent + 1;
  }
  return std::max(spacing, exponent - 31);
}

/// Where an axis without extent keeps its value: any step will do in the affine form, and in the
/// rational one a power of two that divides it.
void placeConstant(Grid& grid, std::size_t axis, double value) {
  const AxisMap map(grid, axis);
  if (map.reaches(value) && map.snap(value).error == 0) return;
  if (grid.form == Grid::Form::Affine) {
    grid.axes[axis].origin = value;
    return;
  }
  const Ratio step = makeRatio(1, 1, spacingExponent(ScalarType::Float64, value));
  if (!setRational(grid.axes[axis], step)) grid.form = Grid::Form::Affine;
}

/// The affine form of a grid from zero, for values whose steps the rational form cannot hold.
Grid affineFromZero(const Grid& rational) {
  Grid grid;
  grid.scalarType = rational.scalarType;
  grid.form = Grid::Form::Affine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.axes[axis].step = AxisMap(rational, axis).step();
  }
  return grid;
}

/// The least double that is at least `step` and short to store if few bits of it matter.
double shortStep(double step, bool asFloat) {
  if (!asFloat || step > std::numeric_limits<float>::max() ||
      step < std::numeric_limits<float>::min()) {
    return step;
  }
  float single = nearestFloat(step);
  if (double{single} < step) {
    single = std::nextafter(single, std::numeric_limits<float>::infinity());
  }
  return std::isfinite(single) ? double{single} : step;
}

double nextStep(double step, bool asFloat) {
  return shortStep(std::nextafter(step, std::numeric_limits<double>::infinity()), asFloat);
}

/// The minimum, or where that takes more than a float to store, a shorter number within an
/// eighth of a step below it.
double shortOrigin(double min, double step) {
  if (double{nearestFloat(min)} == min) return min + 0.0;
  int exponent = 0;
  std::frexp(step, &exponent);  // 2^(exponent − 1) ≤ step
  const double unit = std::ldexp(1, exponent - 1 - 3);
  const double multiple = unit > 0 ? std::floor(min / unit) : kMaxMultiple;
  if (!(std::fabs(multiple) < kMaxMultiple)) return min;
  return multiple * unit + 0.0;
}

bool allWithin(const Grid& grid, const Ranges& ranges, double maxIndex) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisMap map(grid, axis);
    if (!map.reaches(ranges[axis].max)) return false;
    if (map.snap(ranges[axis].max).multiple > maxIndex) return false;
  }
  return true;
}

/// The rational form of an affine grid whose origins are multiples of its step, if every double
/// of the affine form is then computed without rounding, and so equal in both forms.
std::optional<Grid> asRational(const Grid& affine, double maxIndex) {
  const double step = affine.axes[0].step;
  int exponent = 0;
  const double fraction = std::frexp(step, &exponent);
  const Ratio ratio =
      makeRatio(static_cast<std::uint64_t>(std::ldexp(fraction, 53)), 1, exponent - 53);
  Grid grid;
  grid.scalarType = affine.scalarType;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin = affine.axes[axis].origin;
    const double multiple = std::fabs(origin / step) + maxIndex;
    if (std::fmod(origin, step) != 0) return std::nullopt;
    if (multiple * static_cast<double>(ratio.numerator) >= kMaxMultiple) return std::nullopt;
    if (!setRational(grid.axes[axis], ratio)) return std::nullopt;
  }
  return grid;
}

}  // namespace

Grid defaultGrid(ScalarType type, const Ranges& ranges) {
  Grid grid = gridOf(type, makeRatio(1, 1, defaultExponent(type, ranges)));
  for (int attempt = 0; attempt < 2; ++attempt) {
    const Grid::Form form = grid.form;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (ranges[axis].constant()) placeConstant(grid, axis, ranges[axis].min);
    }
    if (grid.form == form) break;
    grid = affineFromZero(gridOf(type, makeRatio(1, 1, defaultExponent(type, ranges))));
  }
  return grid;
}

Grid gridWithBits(ScalarType type, const Ranges& ranges, unsigned bits) {
  // Floats keep an eighth of a step over 2^20 of them.
  const bool asFloat = bits <= 20;
  const double maxIndex = std::ldexp(1, static_cast<int>(bits)) - 1;
  double extent = 0;
  for (const AxisRange& range : ranges) extent = std::max(extent, range.extent());
  if (!std::isfinite(extent)) {
    throw Error(ErrorCode::OutOfGrid,
                "the coordinates are further apart than the largest double, so that " +
                    std::to_string(bits) + " bits cannot span them; scale the coordinates down");
  }
  double step = std::max(extent / maxIndex, std::numeric_limits<double>::denorm_min());
  if (!isFloatingPoint(type)) step = std::max(step, 1.0);  // nothing lies between integers
  step = shortStep(step, asFloat);
  Grid grid;
  grid.form = Grid::Form::Affine;
  grid.scalarType = type;
  // A shorter origin, or the coarseness of the least doubles, may ask for a wider step.
  for (unsigned attempt = 0; attempt < 64; ++attempt, step = nextStep(step, asFloat)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grid.axes[axis].step = step;
      grid.axes[axis].origin = shortOrigin(ranges[axis].min, step);
    }
    if (allWithin(grid, ranges, maxIndex)) break;
  }
  const auto rational = asRational(grid, maxIndex);
  return rational ? *rational : grid;
}

Grid gridWithPrecision(ScalarType type, const Ranges& ranges, double precision) {
  Grid grid;
  grid.scalarType = type;
  const auto ratio = decimalRatio(precision);
  bool rational = ratio.has_value();
  for (std::size_t axis = 0; axis < 3 && rational; ++axis) {
    rational = setRational(grid.axes[axis], *ratio);
    const AxisMap map(grid, axis);
    rational = rational && map.reaches(ranges[axis].min) && map.reaches(ranges[axis].max);
    // The product with the numerator must not round either.
    const double odd = rational ? static_cast<double>(ratio->numerator) : 1;
    rational = rational && std::fabs(map.quotient(ranges[axis].maxAbs())) * odd < kMaxMultiple;
  }
  if (rational) return grid;
  grid = Grid{};
  grid.scalarType = type;
  grid.form = Grid::Form::Affine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.axes[axis].origin = ranges[axis].min + 0.0;
    grid.axes[axis].step = precision;
  }
  return grid;
}

}  // namespace bspc::lattice
