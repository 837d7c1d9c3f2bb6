#pragma once

#include <array>
#include <optional>

#include "bspc/grid.h"
#include "grid/coordinates.h"

namespace bspc::lattice {

/// Finds a lattice with an origin of its own, such as origin + i · step of earlier quantised data
/// (perhaps rounded to float since), that restores every coordinate exactly. Steps are at least
/// `finest` along each axis. Work is bounded by a sort of a few thousand samples for each axis,
/// and by a few passes over all points once a sample has agreed.
std::optional<Grid> detectAffine(const Coordinates& coordinates, const Ranges& ranges,
                                 const std::array<double, 3>& finest);

}  // namespace bspc::lattice
