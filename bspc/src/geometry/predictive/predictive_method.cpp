#include "geometry/predictive/predictive_method.h"

#include "geometry/predictive/tile_coding.h"

namespace bspc::geometry {

namespace {

#if defined(BSPC_HAS_AVX2_CODING)
bool hasAvx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#endif

}  // namespace

EncodedTile PredictiveMethod::encode(const TileInput& tile, const PointProgress& progress) const {
#if defined(BSPC_HAS_AVX2_CODING)
  if (hasAvx2()) return predictive::encodeAvx2(tile, progress);
#endif
  return predictive::encodePortable(tile, progress);
}

DecodedTile PredictiveMethod::decode(const TileToDecode& tile,
                                     const PointProgress& progress) const {
#if defined(BSPC_HAS_AVX2_CODING)
  if (hasAvx2()) return predictive::decodeAvx2(tile, progress);
#endif
  return predictive::decodePortable(tile, progress);
}

}  // namespace bspc::geometry
