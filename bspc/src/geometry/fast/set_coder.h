#pragma once

#include "geometry/fast/slab_body.h"
#include "geometry/fast/tile_frame.h"

namespace bspc::geometry::fast {

/// Codes a set of points in no particular order, in the smallest of the ways that the effort
/// (1 … 4, quickest to smallest) tries.
CodedSet encodeSet(const TileFrame& frame, const SetPoints& points, unsigned effort);

/// Decodes what encodeSet() wrote; any bytes are safe.
void decodeSet(ByteView payload, std::uint64_t points, const TileToDecode& limits,
               PointCollector& out);

}  // namespace bspc::geometry::fast
