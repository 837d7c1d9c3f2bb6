#include "grid/grid_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "grid/axis_kernel.h"
#include "grid/axis_map.h"
#include "grid/float_grid.h"
#include "grid/known_lattice.h"
#include "grid/lattice.h"
#include "grid/points_in_memory.h"
#include "grid/step_choice.h"

namespace bspc {

namespace lattice {

namespace {

// Shares of the work that are done after each stage.
constexpr double kScanned = 0.1;
constexpr double kGridChosen = 0.5;

std::string text(double value, int digits = 9) {
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return buffer.data();
}

/// Whether any of the numbers is NaN or infinite.
bool anyNonFinite(const Coordinates::Chunk& chunk, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += chunk[i] * 0.0;  // NaN from either
  return sum != 0;
}

/// Marks the points of one chunk that are not finite.
class FiniteMarks {
 public:
  using Marks = std::array<bool, Coordinates::kChunk>;

  FiniteMarks(const Coordinates& coordinates, std::uint64_t first, std::size_t count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates.gather(axis, first, count, chunk_.data());
      if (!anyNonFinite(chunk_, count)) continue;
      any_ = true;
      for (std::size_t i = 0; i < count; ++i) bad_[i] = bad_[i] || !std::isfinite(chunk_[i]);
    }
  }
  bool bad(std::size_t i) const { return bad_[i]; }
  std::size_t count() const {
    return any_ ? static_cast<std::size_t>(std::count(bad_.begin(), bad_.end(), true)) : 0;
  }
  std::size_t firstBad() const {
    return static_cast<std::size_t>(std::find(bad_.begin(), bad_.end(), true) - bad_.begin());
  }

 private:
  Coordinates::Chunk chunk_;
  Marks bad_{};
  bool any_ = false;
};

[[noreturn]] void refuseNonFinite(const PointSetView& points, std::uint64_t index,
                                  std::uint64_t firstIndex, std::uint64_t others) {
  const auto xyz = points.position(index);
  std::size_t axis = 0;
  while (std::isfinite(xyz[axis])) ++axis;
  const std::string number = std::isnan(xyz[axis]) ? "nan" : (xyz[axis] > 0 ? "inf" : "-inf");
  const std::string more =
      others == 0 ? "" : " (and " + std::to_string(others) + " more points are not finite)";
  throw Error(ErrorCode::NonFinite, "point " + std::to_string(firstIndex + index) + " has " +
                                        "xyz"[axis] + " = " + number + more +
                                        "; leave such points out with --drop-nonfinite "
                                        "(dropNonFinite in the library), or repair them");
}

/// A step with one significant digit that makes the extent fit.
double coarseEnough(double extent) {
  const double least = extent / kMaxIndex;
  const double unit = std::pow(10, std::floor(std::log10(least)));
  return unit > 0 ? std::ceil(least / unit * (1 + 1e-9)) * unit : least;
}

[[noreturn]] void refuseExtent(const AxisRange& range, std::size_t axis, double step) {
  const double extent = range.max / 2 - range.min / 2;  // halved: the whole may overflow
  const double fitting = 2 * coarseEnough(extent);
  const std::string size = std::isfinite(2 * extent) ? text(2 * extent) : "2 * " + text(extent);
  throw Error(ErrorCode::OutOfGrid, std::string("the extent ") + size + " along " + "xyz"[axis] +
                                        " takes more than the 2^32 steps of " + text(step) +
                                        " that a grid has; use a precision of " + text(fitting, 3) +
                                        " or coarser");
}

[[noreturn]] void refuseFarCoordinate(double value, std::size_t axis, double step) {
  throw Error(ErrorCode::OutOfGrid,
              std::string("the coordinate ") + "xyz"[axis] + " = " + text(value) +
                  " is 2^53 or more steps of " + text(step) +
                  " away from the start of the grid; use a coarser grid or move the points");
}

}  // namespace

void Progress::report(double share) {
  reported_ = std::max(reported_, share);
  if (callback_ && !callback_(reported_)) {
    throw Error(ErrorCode::Cancelled,
                "putting the points on a grid was cancelled by the caller; nothing was kept");
  }
}

FinitePoints finitePoints(const PointSetView& points, bool drop, std::uint64_t firstIndex) {
  FinitePoints result;
  if (allFinite(points)) return result;
  const std::vector<std::uint64_t> none;
  const ViewCoordinates all(points, none);
  std::uint64_t firstBad = 0;
  for (std::uint64_t first = 0; first < all.size(); first += Coordinates::kChunk) {
    const FiniteMarks marks(all, first, all.chunkSize(first));
    const std::size_t count = marks.count();
    if (result.dropped == 0 && count > 0) firstBad = first + marks.firstBad();
    result.dropped += count;
  }
  if (result.dropped == 0) return result;
  if (!drop) refuseNonFinite(points, firstBad, firstIndex, result.dropped - 1);
  result.kept.reserve(static_cast<std::size_t>(all.size() - result.dropped));
  for (std::uint64_t first = 0; first < all.size(); first += Coordinates::kChunk) {
    const std::size_t size = all.chunkSize(first);
    const FiniteMarks marks(all, first, size);
    for (std::size_t i = 0; i < size; ++i) {
      if (!marks.bad(i)) result.kept.push_back(first + i);
    }
  }
  return result;
}

Ranges rangesOf(const Coordinates& coordinates) {
  if (const PointSetView* points = coordinates.inMemory()) return rangesInMemory(*points);
  Ranges ranges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Several at a time, so that no comparison waits for the one before.
    constexpr std::size_t kLanes = 8;
    std::array<double, kLanes> low;
    std::array<double, kLanes> high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    Coordinates::Chunk chunk{};
    for (std::uint64_t first = 0; first < coordinates.size(); first += Coordinates::kChunk) {
      const std::size_t count = coordinates.chunkSize(first);
      coordinates.gather(axis, first, count, chunk.data());
      for (std::size_t i = 0; i < count; ++i) {
        low[i % kLanes] = std::min(low[i % kLanes], chunk[i]);
        high[i % kLanes] = std::max(high[i % kLanes], chunk[i]);
      }
    }
    ranges[axis] = {*std::min_element(low.begin(), low.end()) + 0.0,
                    *std::max_element(high.begin(), high.end()) + 0.0};
  }
  return ranges;
}

void placeBases(Grid& grid, const Ranges& ranges) {
  if (isFloatGrid(grid)) return placeFloatBases(grid, ranges);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisMap map(grid, axis);
    const AxisRange& range = ranges[axis];
    for (const double end : {range.min, range.max}) {
      if (map.reaches(end)) continue;
      if (!(range.extent() / map.step() <= kMaxIndex)) refuseExtent(range, axis, map.step());
      refuseFarCoordinate(end, axis, map.step());
    }
    const double lowest = map.snap(range.min).multiple;
    if (map.snap(range.max).multiple - lowest > kMaxIndex) refuseExtent(range, axis, map.step());
    grid.axes[axis].base = static_cast<std::int64_t>(lowest);
  }
}

std::uint32_t topIndex(const Grid& grid, std::size_t axis, const AxisRange& range) {
  if (isFloatGrid(grid)) return topFloatIndex(grid, axis, range);
  const double top = AxisMap(grid, axis).snap(range.max).multiple;
  return static_cast<std::uint32_t>(top - static_cast<double>(grid.axes[axis].base));
}

namespace {

/// Grid points of one chunk along one axis.
class ChunkQuantiser {
 public:
  ChunkQuantiser(const PlacedGrid& placed, std::size_t axis, const AxisRange& range)
      : map_(placed.grid, axis),
        axis_(axis),
        base_(static_cast<double>(placed.grid.axes[axis].base)),
        top_(map_.snap(range.max).multiple),
        // The search looks at axes on which points differ.
        exact_(placed.exact && !range.constant()) {}

  void run(const Coordinates::Chunk& values, std::size_t count, std::vector<GridPoint>& points) {
    // Copies, so that the loops need no loads through this.
    const AxisMap map = map_;
    const double base = base_;
    if (exact_ && runNarrow(values, count, points)) return;
    if (exact_) {
      for (std::size_t i = 0; i < count; ++i) {
        points[i][axis_] =
            static_cast<std::uint32_t>(nearestInteger(map.quotient(values[i])) - base);
      }
      return;
    }
    for (std::size_t i = 0; i < count; ++i) points[i][axis_] = snapped(map, values[i]);
  }
  double maxError() const { return maxError_; }

 private:
  /// Numbers on the grid whose multiples have 32 bits; false if they are not such.
  bool runNarrow(const Coordinates::Chunk& values, std::size_t count,
                 std::vector<GridPoint>& points) const {
    std::array<std::int32_t, Coordinates::kChunk> multiples;
    const bool narrow = withKernel(map_, [&](const auto& kernel) {
      return nearestMultiples(kernel, values.data(), count, multiples);
    });
    if (!narrow) return false;
    // Differences have 32 bits, so they are right even if the base has more.
    const auto base = static_cast<std::uint32_t>(static_cast<std::int64_t>(base_));
    for (std::size_t i = 0; i < count; ++i) {
      points[i][axis_] = static_cast<std::uint32_t>(multiples[i]) - base;
    }
    return true;
  }

  std::uint32_t snapped(const AxisMap& map, double value) {
    AxisMap::Snapped snapped = map.snap(value);
    // Ties may be broken differently for neighbours, but nothing may leave the index range.
    if (snapped.multiple < base_ || snapped.multiple > top_) {
      snapped.multiple = std::max(base_, std::min(top_, snapped.multiple));
      snapped.error = std::fabs(map.restored(snapped.multiple) - value);
    }
    maxError_ = std::max(maxError_, snapped.error);
    return static_cast<std::uint32_t>(snapped.multiple - base_);
  }

  AxisMap map_;
  std::size_t axis_;
  double base_;
  double top_;
  bool exact_;
  double maxError_ = 0;
};

}  // namespace

namespace {

constexpr std::uint64_t kReportEvery = 128 * Coordinates::kChunk;

/// The axes of a grid of whole steps that all coordinates are known to lie on.
std::optional<std::array<WholeAxis, 3>> wholeAxes(const Ranges& ranges, const PlacedGrid& placed) {
  if (!placed.exact || placed.grid.form != Grid::Form::Rational) return std::nullopt;
  std::array<WholeAxis, 3> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    const Grid::Axis& axis = placed.grid.axes[k];
    const double lowest = ranges[k].min;
    if (axis.denominator != 1 || !(std::fabs(lowest) < kMaxMultiple)) return std::nullopt;
    // The search looks at axes on which points differ.
    const bool onGrid = !ranges[k].constant() || AxisMap(placed.grid, k).snap(lowest).error == 0;
    if (!onGrid) return std::nullopt;
    axes[k] = {static_cast<std::int64_t>(lowest),
               ExactDivisor(static_cast<std::uint64_t>(axis.numerator))};
  }
  return axes;
}

void quantiseWhole(const PointSetView& view, const std::array<WholeAxis, 3>& axes,
                   const GridPointSink& sink, const ShareReport& report) {
  std::vector<GridPoint> points(Coordinates::kChunk);
  for (std::uint64_t first = 0; first < view.size(); first += Coordinates::kChunk) {
    if (first % kReportEvery == 0) {
      report(static_cast<double>(first) / static_cast<double>(view.size()));
    }
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(Coordinates::kChunk, view.size() - first));
    wholeIndices(view, first, count, axes, points.data());
    sink(first, Span<const GridPoint>(points.data(), count));
  }
}

}  // namespace

std::array<double, 3> quantise(const Coordinates& coordinates, const Ranges& ranges,
                               const PlacedGrid& placed, const GridPointSink& sink,
                               const ShareReport& report) {
  if (isFloatGrid(placed.grid)) {
    quantiseFloats(coordinates, placed.grid, sink, report);
    return {};
  }
  const PointSetView* view = coordinates.inMemory();
  const auto whole = view != nullptr ? wholeAxes(ranges, placed) : std::nullopt;
  if (whole) {
    quantiseWhole(*view, *whole, sink, report);
    return {};
  }
  std::array<ChunkQuantiser, 3> axes{ChunkQuantiser(placed, 0, ranges[0]),
                                     ChunkQuantiser(placed, 1, ranges[1]),
                                     ChunkQuantiser(placed, 2, ranges[2])};
  Coordinates::Chunk chunk{};
  std::vector<GridPoint> points(Coordinates::kChunk);
  const auto total = static_cast<double>(coordinates.size());
  for (std::uint64_t first = 0; first < coordinates.size(); first += Coordinates::kChunk) {
    if (first % kReportEvery == 0) report(static_cast<double>(first) / total);
    const std::size_t count = coordinates.chunkSize(first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates.gather(axis, first, count, chunk.data());
      axes[axis].run(chunk, count, points);
    }
    sink(first, Span<const GridPoint>(points.data(), count));
  }
  return {axes[0].maxError(), axes[1].maxError(), axes[2].maxError()};
}

namespace {

PlacedGrid automaticGrid(const Coordinates& coordinates, const Ranges& ranges,
                         const GridRequest& request) {
  const auto known = request.knownLattice
                         ? confirmedLattice(*request.knownLattice, coordinates, ranges)
                         : std::nullopt;
  const auto lattice = detectLattice(coordinates, ranges);
  if (known && (!lattice || isCoarser(*known, *lattice, ranges))) return {*known, true};
  if (lattice) return {*lattice, true};
  if (isFloatingPoint(coordinates.type())) {
    return {defaultGrid(coordinates.type(), ranges), false};
  }
  Grid wholeNumbers;  // which placing the bases will refuse by the axis that is too large
  wholeNumbers.scalarType = coordinates.type();
  return {wholeNumbers, false};
}

PlacedGrid exactGrid(const Coordinates& coordinates, const Ranges& ranges,
                     const GridRequest& request) {
  if (!isFloatingPoint(coordinates.type())) return automaticGrid(coordinates, ranges, request);
  if (!hasNegativeZero(coordinates)) {
    const PlacedGrid lattice = automaticGrid(coordinates, ranges, request);
    if (lattice.exact) return lattice;
  }
  return {floatGrid(coordinates.type()), true};
}

Grid reusedGrid(ScalarType type, const Grid& reuse) {
  if (isFloatGrid(reuse) && reuse.scalarType != type) {
    throw Error(ErrorCode::InvalidArgument, std::string("the grid holds the bits of ") +
                                                scalarName(reuse.scalarType) +
                                                " and the points are " + scalarName(type) +
                                                "; convert them, or choose another grid");
  }
  Grid grid = reuse;
  grid.scalarType = type;
  return grid;
}

/// Bases are not placed yet.
PlacedGrid chooseGrid(const Coordinates& coordinates, const Ranges& ranges,
                      const GridRequest& request) {
  const ScalarType type = coordinates.type();
  const bool point = ranges[0].constant() && ranges[1].constant() && ranges[2].constant();
  switch (request.kind) {
    case GridRequest::Kind::Bits:
      if (!point) return {gridWithBits(type, ranges, request.bits), false};
      break;
    case GridRequest::Kind::Precision:
      return {gridWithPrecision(type, ranges, request.precision), false};
    case GridRequest::Kind::Reuse:
      return {reusedGrid(type, request.reuse), false};
    case GridRequest::Kind::ExactFloats:
      return exactGrid(coordinates, ranges, request);
    case GridRequest::Kind::Automatic:
      break;
  }
  return automaticGrid(coordinates, ranges, request);
}

/// Puts the points on fit.grid.
void quantiseInto(GridFit& fit, bool exact, const Coordinates& coordinates, const Ranges& ranges,
                  Progress& progress) {
  fit.points.clear();
  fit.points.reserve(static_cast<std::size_t>(coordinates.size()));
  const auto sink = [&fit](std::uint64_t /*first*/, Span<const GridPoint> points) {
    fit.points.insert(fit.points.end(), points.begin(), points.end());
  };
  fit.maxError = quantise(coordinates, ranges, {fit.grid, exact}, sink, [&progress](double share) {
    progress.report(kGridChosen + (1 - kGridChosen) * share);
  });
  fit.exact = fit.maxError[0] == 0 && fit.maxError[1] == 0 && fit.maxError[2] == 0;
}

/// Throws Error(OutOfGrid) if points lie below the bases or too far above them.
void requireAboveBases(const Grid& grid, const Ranges& ranges) {
  Grid own = grid;
  placeBases(own, ranges);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t base = grid.axes[axis].base;
    if (own.axes[axis].base < base) {
      throw Error(ErrorCode::OutOfGrid, std::string("the coordinate ") + "xyz"[axis] + " = " +
                                            text(ranges[axis].min) +
                                            " lies below the grid that is to be kept as it is");
    }
    // Floats of a grid of float bits never lie too far above it.
    if (isFloatGrid(grid)) continue;
    const double top = AxisMap(grid, axis).snap(ranges[axis].max).multiple;
    if (top - static_cast<double>(base) > kMaxIndex) {
      throw Error(ErrorCode::OutOfGrid, std::string("the coordinate ") + "xyz"[axis] + " = " +
                                            text(ranges[axis].max) +
                                            " lies above the grid that is to be kept as it is");
    }
  }
}

}  // namespace

PlacedGrid placedGrid(const Coordinates& coordinates, const Ranges& ranges,
                      const GridRequest& request) {
  PlacedGrid placed = chooseGrid(coordinates, ranges, request);
  if (request.kind == GridRequest::Kind::Reuse && request.keepBase) {
    requireAboveBases(placed.grid, ranges);
  } else {
    placeBases(placed.grid, ranges);
  }
  return placed;
}

void validate(const GridRequest& request) {
  if (request.kind == GridRequest::Kind::Bits) GridRequest::withBits(request.bits);
  if (request.kind == GridRequest::Kind::Precision) GridRequest::withPrecision(request.precision);
  if (request.kind == GridRequest::Kind::Reuse) request.reuse.validate();
  if (request.knownLattice) request.knownLattice->validate();
}

Grid emptyGrid(ScalarType type, const GridRequest& request) {
  Grid grid;
  if (request.kind == GridRequest::Kind::Reuse) grid = reusedGrid(type, request.reuse);
  for (Grid::Axis& axis : grid.axes) axis.base = 0;
  grid.scalarType = type;
  return grid;
}

bool needsDoubles(const Grid& grid, const std::array<double, 3>& maxError,
                  const GridRequest& request) {
  if (request.kind != GridRequest::Kind::Precision) return false;
  const double allowed = request.precision / 2 * (1 + 1e-9);
  return grid.scalarType != ScalarType::Float64 &&
         *std::max_element(maxError.begin(), maxError.end()) > allowed;
}

}  // namespace lattice

GridFit fitGrid(const PointSetView& points, const GridRequest& request,
                const ProgressCallback& progress) {
  lattice::validate(request);
  lattice::Progress stages(progress);
  stages.report(0);
  lattice::requireIntegersInDoubles(points);
  lattice::FinitePoints finite = lattice::finitePoints(points, request.dropNonFinite);
  GridFit fit;
  fit.sourceIndex = std::move(finite.kept);
  fit.dropped = finite.dropped;
  if (fit.dropped == points.size()) {
    fit.grid = lattice::emptyGrid(points.type(), request);
    stages.report(1);
    return fit;
  }
  const lattice::ViewCoordinates coordinates(points, fit.sourceIndex);
  const lattice::Ranges ranges = lattice::rangesOf(coordinates);
  stages.report(lattice::kScanned);
  const lattice::PlacedGrid placed = lattice::placedGrid(coordinates, ranges, request);
  fit.grid = placed.grid;
  lattice::quantiseInto(fit, placed.exact, coordinates, ranges, stages);
  if (lattice::needsDoubles(fit.grid, fit.maxError, request)) {
    fit.grid.scalarType = ScalarType::Float64;
    lattice::placeBases(fit.grid, ranges);
    lattice::quantiseInto(fit, false, coordinates, ranges, stages);
  }
  stages.report(1);
  return fit;
}

}  // namespace bspc
