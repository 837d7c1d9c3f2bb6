#pragma once

#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/point_set.h"

namespace bspc {

/// The low halves of all points of a float64 set, finite or not.
std::vector<GridPoint> lowHalvesOf(const PointSetView& points);

/// Low halves as an array, which has no name; they must outlive it.
ArrayView lowHalvesView(const std::vector<GridPoint>& halves);

}  // namespace bspc
