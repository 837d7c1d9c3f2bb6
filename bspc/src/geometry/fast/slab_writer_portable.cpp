#include "geometry/fast/slab_writer.h"
#include "geometry/fast/slab_writer_body.h"

namespace bspc::geometry::fast {

std::vector<std::uint32_t> writeSlabsPortable(const TileFrame& frame, const SetPoints& points,
                                              const SlabOptions& options,
                                              container::ByteWriter& out) {
  return write(frame, points, options, out);
}

std::vector<std::uint32_t> writeSlabs(const TileFrame& frame, const SetPoints& points,
                                      const SlabOptions& options, container::ByteWriter& out) {
  return hasAvx2Slabs() ? writeSlabsAvx2(frame, points, options, out)
                        : writeSlabsPortable(frame, points, options, out);
}

}  // namespace bspc::geometry::fast
