#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/grid.h"
#include "grid/axis_map.h"
#include "grid/coordinates.h"

namespace bspc::lattice {

/// The distance from |x| to the next number of a floating-point type, as the exponent of two.
int spacingExponent(ScalarType type, double x);

/// Whether the multiples between the two ends of the range are few enough for 32-bit indices.
bool fitsIndices(const AxisMap& map, const AxisRange& range);

/// Whether every coordinate along an axis is restored as the very number that it is. If asked for,
/// `divisor` becomes the greatest common divisor of the multiples (0 if all are 0).
bool liesOn(const Coordinates& coordinates, std::size_t axis, const AxisMap& map,
            std::uint64_t* divisor = nullptr);

/// Finds the coarsest lattice that every coordinate lies on exactly; bases are left at zero.
/// Integers lie on one unless an extent needs more than 32 bits.
std::optional<Grid> detectLattice(const Coordinates& coordinates, const Ranges& ranges);

}  // namespace bspc::lattice
