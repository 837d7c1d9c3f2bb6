#include "grid/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "grid/affine_lattice.h"
#include "grid/axis_kernel.h"
#include "grid/exact_divisor.h"
#include "grid/points_in_memory.h"
#include "grid/ratio.h"

namespace bspc::lattice {

int spacingExponent(ScalarType type, double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  if (x == 0) exponent = -2000;
  return type == ScalarType::Float32 ? std::max(exponent - 24, -149)
                                     : std::max(exponent - 53, -1074);
}

bool fitsIndices(const AxisMap& map, const AxisRange& range) {
  if (!map.reaches(range.min) || !map.reaches(range.max)) return false;
  return map.snap(range.max).multiple - map.snap(range.min).multiple <= kMaxIndex;
}

namespace {

/// Coordinates tried before all: most wrong guesses fail there.
constexpr std::size_t kProbe = 128;

class Checker {
 public:
  Checker(const AxisMap& map, bool wantsDivisor) : map_(map), wantsDivisor_(wantsDivisor) {}
  std::uint64_t divisor() const { return any_ ? divisor_.value() : 0; }

  bool operator()(double value) {
    if (!map_.reaches(value)) return false;
    const double multiple = nearestInteger(map_.quotient(value));
    if (map_.restored(multiple) != value) return false;
    if (wantsDivisor_) take(static_cast<std::uint64_t>(std::fabs(multiple)));
    return true;
  }

  /// All of a chunk; the divisor means nothing if not all of them lie on the lattice.
  bool operator()(const Coordinates::Chunk& values, std::size_t count) {
    std::array<std::int32_t, Coordinates::kChunk> multiples;
    bool restores = false;
    const bool narrow = withKernel(map_, [&](const auto& kernel) {
      if (!nearestMultiples(kernel, values.data(), count, multiples)) return false;
      std::uint64_t different = 0;
      for (std::size_t i = 0; i < count; ++i) {
        different |= kernel.restored(multiples[i]) == values[i] ? 0U : 1U;
      }
      restores = different == 0;
      return true;
    });
    if (!narrow) {
      return std::all_of(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count),
                         [this](double value) { return (*this)(value); });
    }
    if (!restores || !wantsDivisor_) return restores;
    for (std::size_t i = 0; i < count && divisor() != 1; ++i) {
      take(static_cast<std::uint64_t>(std::abs(std::int64_t{multiples[i]})));
    }
    return true;
  }

 private:
  void take(std::uint64_t k) {
    if (k == 0 || (any_ && divisor_.divides(k))) return;
    divisor_ = ExactDivisor(any_ ? std::gcd(divisor_.value(), k) : k);
    any_ = true;
  }

  AxisMap map_;
  bool wantsDivisor_;
  bool any_ = false;
  ExactDivisor divisor_;  ///< of what was not zero
};

/// The largest power of two that divides `value`, which is not zero, as exponent.
int trailingExponent(double value) {
  int exponent = 0;
  double fraction = std::frexp(value, &exponent);
  auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  exponent -= 53;
  while (mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
  return exponent;
}

bool isMultiple(double value, double powerOfTwo) {
  const double ratio = value / powerOfTwo;
  if (std::fabs(ratio) >= kMaxMultiple) return true;  // has no bits below one
  if (ratio == 0) return value == 0;                  // else it has underflowed
  return static_cast<double>(static_cast<std::int64_t>(ratio)) == ratio;
}

/// Lattices through zero: every coordinate is a multiple of a step that is a ratio.
class RatioSearch {
 public:
  RatioSearch(const Coordinates& coordinates, const Ranges& ranges)
      : coordinates_(coordinates), ranges_(ranges), type_(coordinates.type()) {}

  std::optional<Grid> run();
  /// Whether a step was found only as a power of two: a coarser lattice off zero is then likely.
  bool binaryOnly() const { return binaryOnly_; }

 private:
  using Steps = std::array<Ratio, 3>;

  AxisMap mapOf(const Ratio& step) const { return {gridOf(type_, step), 0}; }
  std::optional<Ratio> ownStep(std::size_t axis, bool coarsest);
  std::optional<Ratio> decimalStep(std::size_t axis, bool coarsest) const;
  std::optional<Ratio> binaryStep(std::size_t axis, bool coarsest, double above) const;
  std::optional<Ratio> sharedStep(const Steps& own, const std::array<bool, 3>& moving) const;
  Ratio constantStep(std::size_t axis, const Steps& steps, const std::array<bool, 3>& moving);
  std::optional<Grid> gridWith(const Steps& steps) const;

  const Coordinates& coordinates_;
  const Ranges& ranges_;
  ScalarType type_;
  bool binaryOnly_ = false;
};

std::optional<Ratio> RatioSearch::decimalStep(std::size_t axis, bool coarsest) const {
  const AxisRange& range = ranges_[axis];
  const double finest =
      type_ == ScalarType::Float32 ? std::ldexp(1, spacingExponent(type_, range.maxAbs())) : 0;
  std::uint64_t denominator = 1;
  const unsigned decimals = isFloatingPoint(type_) ? 9 : 0;
  for (unsigned d = 0; d <= decimals; ++d, denominator *= 10) {
    const Ratio step = makeRatio(1, denominator);
    const AxisMap map = mapOf(step);
    if (map.step() < finest) break;
    // Whole numbers may have a common divisor that makes them fit.
    if (d > 0 && !fitsIndices(map, range)) break;
    std::uint64_t divisor = 0;
    if (!liesOn(coordinates_, axis, map, coarsest ? &divisor : nullptr)) continue;
    // The same quotient in lower terms: both divisions round the same exact number.
    const Ratio coarse = divisor == 0 ? step : makeRatio(divisor, denominator);
    if (fitsIndices(mapOf(coarse), range)) return coarse;
    break;
  }
  return std::nullopt;
}

std::optional<Ratio> RatioSearch::binaryStep(std::size_t axis, bool coarsest, double above) const {
  const AxisRange& range = ranges_[axis];
  int lowest = spacingExponent(type_, range.maxAbs());
  if (type_ == ScalarType::Float64) {
    // Eight bits more than an index has: a common divisor may remove them.
    const double span = std::isfinite(range.extent()) ? range.extent() : range.maxAbs();
    lowest = std::max(lowest, spacingExponent(type_, span) + 53 - 40);
  }
  int exponent = 1024;
  double power = 0;
  const auto lower = [&](double value) {
    if (value == 0 || (exponent < 1024 && isMultiple(value, power))) return true;
    exponent = std::min(exponent, trailingExponent(value));
    power = std::ldexp(1, exponent);
    return exponent >= lowest;
  };
  const std::vector<double> probe = coordinates_.sample(axis, kProbe);
  if (!std::all_of(probe.begin(), probe.end(), lower)) return std::nullopt;
  if (!coordinates_.all(axis, lower)) return std::nullopt;
  if (exponent == 1024) exponent = 0;
  Ratio step = makeRatio(1, 1, exponent);
  std::uint64_t divisor = 0;
  if (!liesOn(coordinates_, axis, mapOf(step), &divisor)) return std::nullopt;
  if (coarsest && divisor != 0) step = makeRatio(divisor, 1, exponent);
  if (step.value() <= above || !fitsIndices(mapOf(step), range)) return std::nullopt;
  return step;
}

std::optional<Ratio> RatioSearch::ownStep(std::size_t axis, bool coarsest) {
  const auto decimal = decimalStep(axis, coarsest);
  // Multiples of a power of ten below 1/2 could have a coarser power of two, whole numbers not.
  if (!isFloatingPoint(type_) || (decimal && decimal->denominator == 1)) return decimal;
  const auto binary = binaryStep(axis, coarsest, decimal ? decimal->value() : 0);
  if (!binary) return decimal;
  binaryOnly_ = true;
  return binary;
}

std::optional<Ratio> RatioSearch::sharedStep(const Steps& own,
                                             const std::array<bool, 3>& moving) const {
  // A shared step is preferred up to this much finer than the finest step of an axis.
  constexpr double kWorthSharing = 16;
  std::optional<Ratio> shared;
  double finest = std::numeric_limits<double>::infinity();
  double maxAbs = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!moving[axis]) continue;
    shared = shared ? commonDivisor(*shared, own[axis]) : own[axis];
    if (!shared) return std::nullopt;
    finest = std::min(finest, own[axis].value());
    maxAbs = std::max(maxAbs, ranges_[axis].maxAbs());
  }
  const AxisMap map = mapOf(*shared);
  if (map.step() < finest / kWorthSharing) return std::nullopt;
  if (type_ == ScalarType::Float32 && map.step() < std::ldexp(1, spacingExponent(type_, maxAbs))) {
    return std::nullopt;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!moving[axis]) continue;
    if (!fitsIndices(map, ranges_[axis])) return std::nullopt;
    if (!(own[axis] == *shared) && !liesOn(coordinates_, axis, map)) return std::nullopt;
  }
  return shared;
}

Ratio RatioSearch::constantStep(std::size_t axis, const Steps& steps,
                                const std::array<bool, 3>& moving) {
  const double value = ranges_[axis].min;
  for (std::size_t other = 0; other < 3; ++other) {
    if (!moving[other]) continue;
    const AxisMap map = mapOf(steps[other]);
    if (map.reaches(value) && map.snap(value).error == 0) return steps[other];
  }
  if (const auto own = decimalStep(axis, false)) return *own;
  return makeRatio(1, 1, trailingExponent(value));  // not zero: that lies on any step
}

std::optional<Grid> RatioSearch::gridWith(const Steps& steps) const {
  Grid grid;
  grid.scalarType = type_;
  bool rational = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rational = setRational(grid.axes[axis], steps[axis]) && rational;
  }
  if (rational) return grid;
  // Steps beyond 2^±62 need the affine form, and all axes have the same form.
  grid = Grid{};
  grid.scalarType = type_;
  grid.form = Grid::Form::Affine;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisRange& range = ranges_[axis];
    Grid::Axis& a = grid.axes[axis];
    a.step = steps[axis].value();
    if (steps[axis].denominator != 1) a.origin = range.min + 0.0;
    const AxisMap map(grid, axis);
    if (!fitsIndices(map, range) || !liesOn(coordinates_, axis, map)) return std::nullopt;
  }
  return grid;
}

std::optional<Grid> RatioSearch::run() {
  std::array<bool, 3> moving{};
  for (std::size_t axis = 0; axis < 3; ++axis) moving[axis] = !ranges_[axis].constant();
  const bool allConstant = !(moving[0] || moving[1] || moving[2]);
  if (allConstant) moving.fill(true);
  Steps steps;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!moving[axis]) continue;
    // The divisor of one number says nothing about a lattice.
    const auto own = ownStep(axis, !allConstant);
    if (!own) return std::nullopt;
    steps[axis] = *own;
  }
  if (const auto shared = sharedStep(steps, moving)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (moving[axis]) steps[axis] = *shared;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!moving[axis]) steps[axis] = constantStep(axis, steps, moving);
  }
  return gridWith(steps);
}

}  // namespace

bool liesOn(const Coordinates& coordinates, std::size_t axis, const AxisMap& map,
            std::uint64_t* divisor) {
  Checker probe(map, false);
  for (const double value : coordinates.sample(axis, kProbe)) {
    if (!probe(value)) return false;
  }
  Checker check(map, divisor != nullptr);
  // Integers need no check, only their divisor, which seldom takes many of them.
  const bool whole = map.isIdentity();
  const PointSetView* points = coordinates.inMemory();
  if (map.isWhole() && points != nullptr) {
    if (whole && divisor == nullptr) return true;
    const auto common = wholeDivisor(*points, axis);
    if (common && divisor != nullptr) *divisor = *common;
    return common.has_value();
  }
  if (!whole) {
    const bool all =
        coordinates.allChunks(axis, [&check](const Coordinates::Chunk& chunk, std::size_t count) {
          return check(chunk, count);
        });
    if (!all) return false;
  } else if (divisor != nullptr) {
    const bool all = coordinates.all(
        axis, [&check](double value) { return check(value) && check.divisor() != 1; });
    if (!all && check.divisor() != 1) return false;
  }
  if (divisor != nullptr) *divisor = check.divisor();
  return true;
}

std::optional<Grid> detectLattice(const Coordinates& coordinates, const Ranges& ranges) {
  RatioSearch search(coordinates, ranges);
  const auto grid = search.run();
  if (!isFloatingPoint(coordinates.type()) || (grid && !search.binaryOnly())) return grid;
  // Numbers quantised from an origin of their own are multiples of some fine power of two as
  // well; a few points prove no coarser lattice, though.
  constexpr std::uint64_t kEnough = 64;
  constexpr double kWorthLeaving = 4;
  if (grid && coordinates.size() < kEnough) return grid;
  std::array<double, 3> finest{};
  if (grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      finest[axis] = kWorthLeaving * AxisMap(*grid, axis).step();
    }
  }
  const auto affine = detectAffine(coordinates, ranges, finest);
  return affine ? affine : grid;
}

}  // namespace bspc::lattice
