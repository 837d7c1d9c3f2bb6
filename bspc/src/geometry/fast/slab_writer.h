#pragma once

#include <cstdint>
#include <vector>

#include "geometry/fast/slab_body.h"

namespace bspc::geometry::fast {

// writeSlabs(), compiled for different instructions; the bytes are the same.

std::vector<std::uint32_t> writeSlabsPortable(const TileFrame& frame, const SetPoints& points,
                                              const SlabOptions& options,
                                              container::ByteWriter& out);

/// Only if hasAvx2Slabs().
std::vector<std::uint32_t> writeSlabsAvx2(const TileFrame& frame, const SetPoints& points,
                                          const SlabOptions& options, container::ByteWriter& out);

}  // namespace bspc::geometry::fast
