#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"

namespace bspc {

/// Widens the report's errors by those of points that a lossy coding moved: input point sources[j]
/// comes back at lower + decoded[j].
void addLossyError(const PointSetView& points, const std::vector<std::uint64_t>& sources,
                   const std::vector<GridPoint>& decoded, const GridPoint& lower,
                   EncodeReport& report);

}  // namespace bspc
