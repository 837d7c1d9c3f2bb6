#include "grid/affine_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "grid/axis_map.h"
#include "grid/lattice.h"
#include "grid/step_interval.h"

namespace bspc::lattice {

namespace {

/// Enough that on lattices of 2^20 steps some samples are neighbours.
constexpr std::size_t kSample = 4096;

class AffineSearch {
 public:
  AffineSearch(const Coordinates& coordinates, const Ranges& ranges,
               const std::array<double, 3>& finest)
      : coordinates_(coordinates), ranges_(ranges), finest_(finest), type_(coordinates.type()) {}

  std::optional<Grid> run();

 private:
  using Intervals = std::array<std::optional<StepInterval>, 3>;

  bool constant(std::size_t axis) const { return ranges_[axis].constant(); }
  double finestStep(std::size_t axis) const;
  std::vector<StepInterval> sampledSteps(std::size_t axis) const;
  std::optional<StepInterval> narrowFromMinimum(std::size_t axis, const StepInterval& sample) const;
  bool accepts(std::size_t axis, double origin, double step) const;
  void set(Grid& grid, std::size_t axis, double origin, double step) const;
  Grid emptyGrid() const;

  bool sampleAll();
  std::optional<Grid> fromMinima() const;
  std::optional<Grid> sharedFromMinima(const Intervals& intervals) const;
  std::optional<Grid> ownFromMinima(const Intervals& intervals) const;
  std::optional<Grid> fromRoundOffsets() const;
  std::optional<double> roundOffset(std::size_t axis, double step) const;

  const Coordinates& coordinates_;
  const Ranges& ranges_;
  const std::array<double, 3>& finest_;
  ScalarType type_;
  std::array<std::vector<StepInterval>, 3> sampled_;
};

double AffineSearch::finestStep(std::size_t axis) const {
  // Nearer to the spacing of the numbers themselves anything looks like a lattice.
  const AxisRange& range = ranges_[axis];
  const double spacing = std::ldexp(1, spacingExponent(type_, range.maxAbs()));
  return std::max({finest_[axis], 3 * spacing, range.extent() / kMaxIndex});
}

std::vector<StepInterval> AffineSearch::sampledSteps(std::size_t axis) const {
  std::vector<double> values = coordinates_.sample(axis, kSample);
  values.push_back(ranges_[axis].min);
  values.push_back(ranges_[axis].max);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const double largest = ranges_[axis].maxAbs();
  // Two values alone are one step apart.
  if (values.size() == 2) {
    const double extent = ranges_[axis].extent();
    if (!std::isfinite(extent) || extent < finestStep(axis)) return {};
    return {{extent, extent}};
  }
  return stepsOfSample(values, roundingNoise(type_, largest, largest), finestStep(axis));
}

/// All the coordinates' say: the steps that lead from the minimum to every one of them.
std::optional<StepInterval> AffineSearch::narrowFromMinimum(std::size_t axis,
                                                            const StepInterval& sample) const {
  const double origin = ranges_[axis].min;
  const double extent = ranges_[axis].extent();
  const double middle = sample.middle();
  StepInterval interval = sample;
  const bool possible = coordinates_.all(axis, [&](double value) {
    const double distance = value - origin;
    const double multiple = nearestInteger(distance / middle);
    const double noise = roundingNoise(type_, value, extent);
    if (multiple == 0) return distance <= noise;
    if (interval.low * multiple < distance - noise) interval.low = (distance - noise) / multiple;
    if (interval.high * multiple > distance + noise) interval.high = (distance + noise) / multiple;
    return interval.low <= interval.high * (1 + 1e-15);
  });
  if (!possible) return std::nullopt;
  if (interval.empty()) std::swap(interval.low, interval.high);
  return interval;
}

Grid AffineSearch::emptyGrid() const {
  Grid grid;
  grid.form = Grid::Form::Affine;
  grid.scalarType = type_;
  return grid;
}

void AffineSearch::set(Grid& grid, std::size_t axis, double origin, double step) const {
  grid.axes[axis].origin = origin + 0.0;
  grid.axes[axis].step = step;
}

bool AffineSearch::accepts(std::size_t axis, double origin, double step) const {
  Grid grid = emptyGrid();
  set(grid, axis, origin, step);
  const AxisMap map(grid, axis);
  return fitsIndices(map, ranges_[axis]) && liesOn(coordinates_, axis, map);
}

/// One step for all axes: the finest, which the others may use only every second, third … of.
std::optional<Grid> AffineSearch::sharedFromMinima(const Intervals& intervals) const {
  double finest = std::numeric_limits<double>::infinity();
  StepInterval shared;
  for (const auto& interval : intervals) {
    if (!interval || interval->middle() >= finest) continue;
    finest = interval->middle();
    shared = *interval;
  }
  for (const auto& interval : intervals) {
    if (!interval) continue;
    const double ratio = nearestInteger(std::min(interval->middle() / finest, kMaxIndex));
    shared.low = std::max(shared.low, interval->low / ratio);
    shared.high = std::min(shared.high, interval->high / ratio);
  }
  if (shared.empty()) return std::nullopt;
  for (const double step : stepCandidates(shared)) {
    Grid grid = emptyGrid();
    bool exact = true;
    for (std::size_t axis = 0; axis < 3 && exact; ++axis) {
      exact = constant(axis) || accepts(axis, ranges_[axis].min, step);
      set(grid, axis, ranges_[axis].min, step);
    }
    if (exact) return grid;
  }
  return std::nullopt;
}

std::optional<Grid> AffineSearch::ownFromMinima(const Intervals& intervals) const {
  Grid grid = emptyGrid();
  double anyStep = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!intervals[axis]) continue;
    const std::vector<double> candidates = stepCandidates(*intervals[axis]);
    const auto step = std::find_if(candidates.begin(), candidates.end(),
                                   [&](double s) { return accepts(axis, ranges_[axis].min, s); });
    if (step == candidates.end()) return std::nullopt;
    set(grid, axis, ranges_[axis].min, *step);
    anyStep = *step;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (constant(axis)) set(grid, axis, ranges_[axis].min, anyStep);
  }
  return grid;
}

std::optional<Grid> AffineSearch::fromMinima() const {
  Intervals intervals;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (constant(axis)) continue;
    for (const StepInterval& sample : sampled_[axis]) {
      intervals[axis] = narrowFromMinimum(axis, sample);
      if (intervals[axis]) break;
    }
    if (!intervals[axis]) return std::nullopt;
  }
  if (const auto shared = sharedFromMinima(intervals)) return shared;
  return ownFromMinima(intervals);
}

/// Round numbers near the data, as surveyors choose for scale-and-offset files.
std::optional<double> AffineSearch::roundOffset(std::size_t axis, double step) const {
  const AxisRange& range = ranges_[axis];
  std::vector<double> offsets{0.0, range.min};
  double unit = 1;
  for (unsigned digits = 0; digits <= 8; ++digits, unit *= 10) {
    const double middle = range.min + range.extent() / 2;
    offsets.push_back(std::floor(range.min / unit) * unit);
    offsets.push_back(std::floor(middle / unit + 0.5) * unit);
    offsets.push_back(std::floor(middle / unit) * unit);
    offsets.push_back(std::ceil(range.max / unit) * unit);
  }
  for (const double offset : offsets) {
    if (std::isfinite(offset) && accepts(axis, offset, step)) return offset;
  }
  return std::nullopt;
}

std::optional<Grid> AffineSearch::fromRoundOffsets() const {
  std::array<double, 3> steps{};
  double finest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (constant(axis)) continue;
    for (const StepInterval& sample : sampled_[axis]) {
      steps[axis] = shortDecimal(sample);
      if (steps[axis] > 0) break;
    }
    if (steps[axis] <= 0) return std::nullopt;
    if (finest <= 0 || steps[axis] < finest) finest = steps[axis];
  }
  Grid grid = emptyGrid();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double step = finest;
    std::optional<double> offset = ranges_[axis].min;
    if (!constant(axis)) {
      offset = roundOffset(axis, step);
      if (!offset && steps[axis] > finest) offset = roundOffset(axis, step = steps[axis]);
    }
    if (!offset) return std::nullopt;
    set(grid, axis, *offset, step);
  }
  return grid;
}

/// False as soon as one axis has no lattice: most data end here.
bool AffineSearch::sampleAll() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (constant(axis)) continue;
    sampled_[axis] = sampledSteps(axis);
    if (sampled_[axis].empty()) return false;
  }
  return true;
}

std::optional<Grid> AffineSearch::run() {
  if (!sampleAll()) return std::nullopt;
  if (const auto grid = fromMinima()) return grid;
  return fromRoundOffsets();
}

}  // namespace

std::optional<Grid> detectAffine(const Coordinates& coordinates, const Ranges& ranges,
                                 const std::array<double, 3>& finest) {
  return AffineSearch(coordinates, ranges, finest).run();
}

}  // namespace bspc::lattice
