#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bspc/grid.h"
#include "grid/coordinates.h"

namespace bspc::lattice {

/// Reports progress, and throws Error(Cancelled) once the callback asks to stop.
class Progress {
 public:
  explicit Progress(const ProgressCallback& callback) : callback_(callback) {}
  /// Shares below one that was reported before are raised to it: a stage may run twice.
  void report(double share);

 private:
  double reported_ = 0;
  const ProgressCallback& callback_;
};

/// The input indices of the points that are finite (empty if all are), and how many are not.
struct FinitePoints {
  std::vector<std::uint64_t> kept;
  std::uint64_t dropped = 0;
};

/// Throws Error(NonFinite) naming the first point that is not finite unless `drop`; `firstIndex` is
/// the index of the view's first point.
FinitePoints finitePoints(const PointSetView& points, bool drop, std::uint64_t firstIndex = 0);

/// Least and greatest coordinates; there is at least one point.
Ranges rangesOf(const Coordinates& coordinates);

/// Throws Error(InvalidArgument) for a request whose numbers are out of range.
void validate(const GridRequest& request);

/// The grid of a set without points.
Grid emptyGrid(ScalarType type, const GridRequest& request);

/// A grid whose bases are placed, and whether every coordinate is known to lie on it.
struct PlacedGrid {
  Grid grid;
  bool exact = false;
};

/// The grid that a request means for these coordinates.
PlacedGrid placedGrid(const Coordinates& coordinates, const Ranges& ranges,
                      const GridRequest& request);

/// Sets the bases to the least multiples of the data. Throws Error(OutOfGrid) naming the axis if
/// the indices would not fit.
void placeBases(Grid& grid, const Ranges& ranges);

/// The greatest index along an axis of a grid whose bases are placed.
std::uint32_t topIndex(const Grid& grid, std::size_t axis, const AxisRange& range);

/// Takes the grid points first, first + 1, …; called in order.
using GridPointSink = std::function<void(std::uint64_t first, Span<const GridPoint> points)>;
using ShareReport = std::function<void(double share)>;

/// Hands every coordinate's grid point on. Returns the greatest error along each axis.
std::array<double, 3> quantise(const Coordinates& coordinates, const Ranges& ranges,
                               const PlacedGrid& placed, const GridPointSink& sink,
                               const ShareReport& report);

/// Whether rounding to the scalar type breaks the promised half of the precision, which the
/// doubles themselves keep.
bool needsDoubles(const Grid& grid, const std::array<double, 3>& maxError,
                  const GridRequest& request);

}  // namespace bspc::lattice
