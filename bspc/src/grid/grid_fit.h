#pragma once

#include <cstdint>
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

/// Throws Error(NonFinite) naming the first point that is not finite unless `drop`.
FinitePoints finitePoints(const PointSetView& points, bool drop);

/// Least and greatest coordinates; there is at least one point.
Ranges rangesOf(const Coordinates& coordinates);

/// Sets the bases to the least multiples of the data. Throws Error(OutOfGrid) naming the axis if
/// the indices would not fit.
void placeBases(Grid& grid, const Ranges& ranges);

/// Fills fit.points, exact and maxError for fit.grid, whose bases are placed.
void quantise(const Coordinates& coordinates, const Ranges& ranges, GridFit& fit,
              Progress& progress);

}  // namespace bspc::lattice
