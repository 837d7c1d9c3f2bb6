#include "geometry/fast/slab_reader.h"
#include "geometry/fast/slab_reader_body.h"

namespace bspc::geometry::fast {

void readSlabsPortable(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
                       std::uint32_t maxDepth, PointCollector& out) {
  read(body, points, uvTree, extraLevels, maxDepth, out);
}

void readSlabs(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
               std::uint32_t maxDepth, PointCollector& out) {
  return hasAvx2Slabs() ? readSlabsAvx2(body, points, uvTree, extraLevels, maxDepth, out)
                        : readSlabsPortable(body, points, uvTree, extraLevels, maxDepth, out);
}

}  // namespace bspc::geometry::fast
