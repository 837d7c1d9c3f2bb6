#include "geometry/fast/slab_writer.h"

// What is not in the namespace of the lane set is compiled for every processor: it comes first.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "container/byte_writer.h"
#include "entropy/symbol_coder.h"
#include "geometry/fast/chunk_coder.h"
#include "geometry/fast/set_points.h"
#include "geometry/fast/slab_curve.h"
#include "geometry/fast/slab_sorter.h"
#include "geometry/fast/slab_tree.h"
#include "geometry/fast/uv_tree.h"

namespace bspc::geometry::fast {

#if defined(__x86_64__) && defined(__GNUC__)

bool hasAvx2Slabs() {
  static const bool has = __builtin_cpu_supports("avx2") != 0 &&
                          __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  return has;
}

}  // namespace bspc::geometry::fast

#define BSPC_LANE_SET avx2

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2")
#endif

#include "geometry/fast/slab_writer_body.h"

namespace bspc::geometry::fast {

std::vector<std::uint32_t> writeSlabsAvx2(const TileFrame& frame, const SetPoints& points,
                                          const SlabOptions& options, container::ByteWriter& out) {
  return write(frame, points, options, out);
}

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else

bool hasAvx2Slabs() { return false; }

std::vector<std::uint32_t> writeSlabsAvx2(const TileFrame&, const SetPoints&, const SlabOptions&,
                                          container::ByteWriter&) {
  throw Error(ErrorCode::Unsupported, "this machine has no AVX2 instructions");
}

#endif

}  // namespace bspc::geometry::fast
