#include "geometry/predictive/tile_coding.h"

#if defined(BSPC_HAS_AVX2_CODING)

// What is not in the namespace of the lane set is compiled for every processor: it comes first.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "entropy/symbol_coder.h"
#include "geometry/cell_output.h"
#include "geometry/kd/kd_order.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/predictive/tile_header.h"
#include "geometry/predictive/tile_structure.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define BSPC_LANE_SET avx2
#define BSPC_LANES_AVX2

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

#include "geometry/predictive/tile_coding_body.h"

namespace bspc::geometry::predictive {

EncodedTile encodeAvx2(const TileInput& tile, const PointProgress& progress) {
  return encode(tile, progress);
}

DecodedTile decodeAvx2(const TileToDecode& tile, const PointProgress& progress) {
  return decode(tile, progress);
}

}  // namespace bspc::geometry::predictive

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif
