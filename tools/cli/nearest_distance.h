#pragma once

#include <array>
#include <vector>

namespace bspc::cli {

/// Greatest distance of a point of `from` to the point of `to` that is nearest to it; neither is
/// empty.
double greatestDistanceToNearest(const std::vector<std::array<double, 3>>& from,
                                 std::vector<std::array<double, 3>> to);

}  // namespace bspc::cli
