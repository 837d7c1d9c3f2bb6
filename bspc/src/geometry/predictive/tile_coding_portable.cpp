#include "geometry/predictive/tile_coding.h"
#include "geometry/predictive/tile_coding_body.h"

namespace bspc::geometry::predictive {

EncodedTile encodePortable(const TileInput& tile, const PointProgress& progress) {
  return encode(tile, progress);
}

DecodedTile decodePortable(const TileToDecode& tile, const PointProgress& progress) {
  return decode(tile, progress);
}

}  // namespace bspc::geometry::predictive
