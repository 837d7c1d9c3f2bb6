#include "geometry/tile_bounds.h"

#include <algorithm>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "entropy/symbol_coder.h"

namespace bspc::geometry {

namespace {

constexpr std::uint64_t kMaxPoints = std::numeric_limits<std::uint32_t>::max();

unsigned bitsOf(const GridPoint& extent) {
  return entropy::bitLength(*std::max_element(extent.begin(), extent.end()));
}

}  // namespace

void checkTileBounds(const char* method, const TileInput& tile, unsigned maxBits) {
  if (tile.points.size() > kMaxPoints) {
    throw Error(ErrorCode::Unsupported, std::string("method ") + method +
                                            " codes at most 4,294,967,295 points in one tile");
  }
  const unsigned bits = bitsOf(tile.extent);
  if (bits <= maxBits) return;
  std::string others;
  for (const Method other : availableMethods()) {
    const GeometryMethod* m = findGeometryMethod(other);
    if (m == nullptr || m->maxBits() < bits) continue;
    others += (others.empty() ? "" : ", ") + std::string(methodName(other));
  }
  throw Error(ErrorCode::Unsupported,
              std::string("method ") + method + " takes grids of up to " + std::to_string(maxBits) +
                  " bits along each axis, and this one has " + std::to_string(bits) +
                  "; use another method (" + others + "), or a coarser grid");
}

void checkTileBounds(const char* method, const TileToDecode& tile, unsigned maxBits) {
  if (tile.points <= kMaxPoints && bitsOf(tile.extent) <= maxBits) return;
  throw Error(ErrorCode::Corrupt,
              std::string("a tile of method ") + method + " is larger than the method allows");
}

}  // namespace bspc::geometry
