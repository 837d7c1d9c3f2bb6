// The build for AVX2 and the portable one are the same coder.

#include <gtest/gtest.h>

#include <vector>

#include "geometry/predictive/tile_coding.h"
#include "support/point_sets.h"
#include "support/tiles.h"

namespace bspc::geometry {
namespace {

#if defined(BSPC_HAS_AVX2_CODING)

class PredictiveVectors : public testing::TestWithParam<unsigned> {};

TEST_P(PredictiveVectors, CodeTheSameBytesAndPoints) {
  if (__builtin_cpu_supports("avx2") == 0) GTEST_SKIP() << "this processor has no AVX2";
  for (const auto& points :
       {test::scannedSphere(1, 1500, 65535), test::scannedSphere(2, 500, 99)}) {
    TileInput tile = test::tileOf(points, 2);
    tile.wishes.effort = GetParam();
    const EncodedTile coded = predictive::encodePortable(tile, {});
    const EncodedTile vectors = predictive::encodeAvx2(tile, {});
    EXPECT_EQ(vectors.layers, coded.layers);
    EXPECT_EQ(vectors.order, coded.order);

    TileToDecode whole;
    whole.points = points.size();
    whole.extent = tile.extent;
    whole.layers = tile.layers;
    whole.payloads.assign(coded.layers.begin(), coded.layers.end());
    whole.maxPoints = points.size();
    whole.maxBytes = std::uint64_t{1} << 30;
    whole.maxDepth = 96;
    const DecodedTile decoded = predictive::decodePortable(whole, {});
    EXPECT_EQ(decoded.points.size(), points.size());
    EXPECT_EQ(predictive::decodeAvx2(whole, {}).points, decoded.points);
  }
}

INSTANTIATE_TEST_SUITE_P(Efforts, PredictiveVectors, testing::Values(5, 6, 7, 8, 9));

#endif

}  // namespace
}  // namespace bspc::geometry
