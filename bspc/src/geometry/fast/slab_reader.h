#pragma once

#include <cstdint>

#include "geometry/fast/slab_body.h"

namespace bspc::geometry::fast {

// readSlabs(), compiled for different instructions; the points are the same.

void readSlabsPortable(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
                       std::uint32_t maxDepth, PointCollector& out);

/// Only if hasAvx2Slabs().
void readSlabsAvx2(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
                   std::uint32_t maxDepth, PointCollector& out);

}  // namespace bspc::geometry::fast
