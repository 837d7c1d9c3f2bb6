#pragma once

#include <optional>

#include "bspc/grid.h"
#include "grid/coordinates.h"

namespace bspc::lattice {

/// The lattice that the caller knows of, if it restores every coordinate as the number that it is;
/// with a multiple of its step where all coordinates allow that. Bases are left at zero.
std::optional<Grid> confirmedLattice(const Grid& known, const Coordinates& coordinates,
                                     const Ranges& ranges);

/// Whether indices on `one` take fewer bits than on `other`, over all axes.
bool isCoarser(const Grid& one, const Grid& other, const Ranges& ranges);

}  // namespace bspc::lattice
