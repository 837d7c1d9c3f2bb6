#include "geometry/fast/slab_reader.h"

// What is not in the namespace of the lane set is compiled for every processor: it comes first.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "container/byte_reader.h"
#include "entropy/symbol_coder.h"
#include "geometry/fast/chunk_coder.h"
#include "geometry/fast/chunk_reader.h"
#include "geometry/fast/slab_curve.h"
#include "geometry/fast/slab_sorter.h"
#include "geometry/fast/slab_tree.h"
#include "geometry/fast/uv_tree.h"

#if defined(__x86_64__) && defined(__GNUC__)

#define BSPC_LANE_SET avx2

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2")
#endif

#include "geometry/fast/slab_reader_body.h"

namespace bspc::geometry::fast {

void readSlabsAvx2(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
                   std::uint32_t maxDepth, PointCollector& out) {
  read(body, points, uvTree, extraLevels, maxDepth, out);
}

}  // namespace bspc::geometry::fast

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else

namespace bspc::geometry::fast {

void readSlabsAvx2(ByteView, std::uint64_t, bool, unsigned, std::uint32_t, PointCollector&) {
  throw Error(ErrorCode::Unsupported, "this machine has no AVX2 instructions");
}

}  // namespace bspc::geometry::fast

#endif
