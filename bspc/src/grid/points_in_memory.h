#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bspc/grid.h"
#include "bspc/point_set.h"
#include "grid/coordinates.h"
#include "grid/exact_divisor.h"

namespace bspc::lattice {

// What the search for grids asks of many points, answered in the numbers' own type: much quicker
// than one by one through doubles, with the same results.

/// Whether no coordinate is NaN or infinite.
bool allFinite(const PointSetView& points);

/// Least and greatest coordinates of a set that is not empty; all must be finite.
Ranges rangesInMemory(const PointSetView& points);

/// Greatest common divisor of the coordinates along an axis, 0 if all are 0; nothing unless they
/// are whole numbers within ±2^53. All must be finite.
std::optional<std::uint64_t> wholeDivisor(const PointSetView& points, std::size_t axis);

/// An axis whose coordinates are `lowest` and multiples of a number above it.
struct WholeAxis {
  std::int64_t lowest = 0;
  ExactDivisor step;
};

/// Grid points of the points first … first + count − 1, which must lie on the axes.
void wholeIndices(const PointSetView& points, std::uint64_t first, std::size_t count,
                  const std::array<WholeAxis, 3>& axes, GridPoint* out);

}  // namespace bspc::lattice
