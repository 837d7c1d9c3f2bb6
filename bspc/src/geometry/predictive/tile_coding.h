#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry::predictive {

// The same coding, compiled for different vector instructions; the bytes are the same.

EncodedTile encodePortable(const TileInput& tile, const PointProgress& progress);
DecodedTile decodePortable(const TileToDecode& tile, const PointProgress& progress);

#if defined(__x86_64__)
#define BSPC_HAS_AVX2_CODING
/// To be called on processors with AVX2 only.
EncodedTile encodeAvx2(const TileInput& tile, const PointProgress& progress);
DecodedTile decodeAvx2(const TileToDecode& tile, const PointProgress& progress);
#endif

}  // namespace bspc::geometry::predictive
