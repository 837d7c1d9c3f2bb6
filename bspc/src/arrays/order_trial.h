#pragma once

#include <cstdint>
#include <vector>

#include "arrays/array_source.h"
#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc {

/// Whether storing the order of the points makes a file smaller because their arrays follow it, as
/// the times of a scan do: tried on points of the middle of a set. `sources` are input indices of
/// the points, empty if they are their own.
bool storedOrderPays(Span<const GridPoint> points, const std::vector<std::uint64_t>& sources,
                     const ArraySource& arrays, unsigned effort);

}  // namespace bspc
