#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Throws Error(Unsupported), naming methods that can, if a tile has more than `maxBits` bits along
/// an axis or 2^32 points or more.
void checkTileBounds(const char* method, const TileInput& tile, unsigned maxBits);

/// Throws Error(Corrupt) if a file claims such a tile.
void checkTileBounds(const char* method, const TileToDecode& tile, unsigned maxBits);

}  // namespace bspc::geometry
