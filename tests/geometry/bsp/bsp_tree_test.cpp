// Streams of method bsp with parameters other than the paper's, which its encoder does not choose
// by itself: the tree coder is driven directly.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "geometry/bsp/bsp_points.h"
#include "geometry/bsp/bsp_tree_coder.h"
#include "support/point_sets.h"

namespace bspc::geometry {
namespace {

constexpr std::uint32_t kAnyDepth = std::numeric_limits<std::uint32_t>::max();

Bytes encodeWith(const BspParameters& parameters, const TileInput& tile) {
  const PointProgress none;
  BspSortedPoints points(tile, none);
  const auto tree = std::make_unique<BspTreeCoder<entropy::SymbolWriter, BspSortedPoints>>(
      tile.extent, points, tile.points.size(), kAnyDepth, parameters);
  entropy::SymbolWriter coder;
  tree->head(coder);
  tree->finalLayer(coder);
  return coder.finish();
}

std::vector<GridPoint> decode(const Bytes& payload, const TileInput& tile) {
  TileToDecode input;
  input.points = tile.points.size();
  input.extent = tile.extent;
  input.payloads.emplace_back(payload);
  input.maxPoints = input.points;
  input.maxBytes = std::uint64_t{1} << 30;
  input.maxDepth = 512;
  return findGeometryMethod(Method::Bsp)->decode(input, {}).points;
}

TEST(BspTree, IsExactWithAnyParameters) {
  const std::vector<GridPoint> points = test::scannedSphere(41, 3000, 4000);
  TileInput tile;
  tile.points = points;
  tile.extent = {4095, 4095, 4095};
  const std::size_t usual = encodeWith(BspParameters(), tile).size();
  for (const unsigned k : {0U, 3U, 31U}) {
    for (const unsigned levelMax : {0U, 10U, 31U}) {
      for (const unsigned slackClass : {0U, 1U, 4U, BspParameters::kLastSlackClass}) {
        SCOPED_TRACE(std::to_string(k) + ", " + std::to_string(levelMax) + ", " +
                     std::to_string(slackClass));
        BspParameters parameters;
        parameters.phiK = parameters.psiK = parameters.alphaK = k;
        parameters.levelMax = levelMax;
        parameters.slackClass = slackClass;
        const Bytes payload = encodeWith(parameters, tile);
        EXPECT_EQ(test::sorted(decode(payload, tile)), test::sorted(points));
        // Planes cost bits, and distrust of vertices more.
        EXPECT_LT(payload.size(), 3 * usual);
      }
    }
  }
}

TEST(BspTree, APointThatItsBoxMissesIsNoticed) {
  // A tile that claims to be smaller than its points need.
  const std::vector<GridPoint> points{{0, 0, 0}, {9, 9, 9}, {200, 9, 9}};
  TileInput tile;
  tile.points = points;
  tile.extent = {99, 99, 99};
  EXPECT_THROW(encodeWith(BspParameters(), tile), BspSortedPoints::Lost);
}

}  // namespace
}  // namespace bspc::geometry
