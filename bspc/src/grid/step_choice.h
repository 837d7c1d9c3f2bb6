#pragma once

#include "bspc/grid.h"
#include "grid/coordinates.h"

namespace bspc::lattice {

/// Where coordinates lie on no lattice: a power of two as step, the spacing of the largest
/// coordinate (float32) or just fine enough for 31 bits (float64). Axes on which all points are
/// equal have steps of their own that keep them exact.
Grid defaultGrid(ScalarType type, const Ranges& ranges);

/// One step for all axes, such that the largest extent spans 2^bits − 1 of them.
/// Throws Error(OutOfGrid) if an extent is beyond the doubles. Some extent is above zero.
Grid gridWithBits(ScalarType type, const Ranges& ranges, unsigned bits);

/// One step for all axes: the shortest decimal number that reads as `precision`.
Grid gridWithPrecision(ScalarType type, const Ranges& ranges, double precision);

}  // namespace bspc::lattice
