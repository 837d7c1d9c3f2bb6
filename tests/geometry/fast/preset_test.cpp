// Every effort of the method, over sets that make it choose each of its ways to code a tile.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bspc/error.h"
#include "geometry/fast/fast_method.h"
#include "geometry/fast/set_coder.h"
#include "geometry/fast/slab_reader.h"
#include "geometry/fast/slab_writer.h"
#include "geometry/kd/kd_method.h"
#include "support/point_sets.h"
#include "support/tiles.h"

namespace bspc::geometry {
namespace {

constexpr unsigned kInputOrderFlag = 1U << 4;

TileInput tileOf(const std::vector<GridPoint>& points, unsigned effort, unsigned layers) {
  TileInput tile = test::tileOf(points, layers);
  tile.wishes.effort = effort;
  return tile;
}

TileToDecode toDecode(const TileInput& tile, const std::vector<Bytes>& layers) {
  TileToDecode decode;
  decode.points = tile.points.size();
  decode.extent = tile.extent;
  decode.layers = tile.layers;
  decode.payloads.assign(layers.begin(), layers.end());
  decode.maxPoints = std::numeric_limits<std::uint32_t>::max();
  decode.maxBytes = std::uint64_t{1} << 30;
  decode.maxDepth = 512;
  return decode;
}

/// Scan lines over a wavy ground: points whose order says much.
std::vector<GridPoint> scanLines(std::size_t count) {
  std::vector<GridPoint> points;
  std::mt19937_64 random(4);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t line = i / 300;
    const std::size_t along = line % 2 == 0 ? i % 300 : 299 - i % 300;
    const double wave = 200 * std::sin(static_cast<double>(along) / 40) +
                        100 * std::cos(static_cast<double>(line) / 15);
    points.push_back(
        {static_cast<std::uint32_t>(37 * along + random() % 3),
         static_cast<std::uint32_t>(41 * line + random() % 5),
         static_cast<std::uint32_t>(400 + wave) + static_cast<std::uint32_t>(random() % 4)});
  }
  return points;
}

/// Nearly flat, on a grid that is wider than 22 bits.
std::vector<GridPoint> wideSheet(std::size_t count) {
  std::mt19937_64 random(6);
  std::vector<GridPoint> points(count);
  for (GridPoint& p : points) {
    p = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()), 0};
    p[2] = static_cast<std::uint32_t>((std::uint64_t{p[0]} + p[1]) / 2 + random() % 1000);
  }
  return points;
}

struct Case {
  const char* name;
  std::vector<GridPoint> points;
};

std::vector<Case> cases() {
  std::vector<GridPoint> shuffled = scanLines(20000);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(9));
  return {{"scan lines", scanLines(20000)},
          {"scan lines, shuffled", shuffled},
          {"sphere", test::scannedSphere(1, 70000, 65535)},
          {"sphere with many equal points", test::scannedSphere(2, 20000, 100)},
          {"wide sheet", wideSheet(9000)},
          {"noise", test::randomPoints(3, 9000, {0xFFFFFFFF, 100000, 0xFFFFFFFF})}};
}

void expectRoundTrip(const TileInput& tile, const EncodedTile& coded) {
  const DecodedTile decoded = FastMethod().decode(toDecode(tile, coded.layers), {});
  ASSERT_EQ(decoded.points.size(), tile.points.size());
  for (std::size_t j = 0; j < decoded.points.size(); ++j) {
    GridPoint p = tile.points[coded.order[j]];
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    ASSERT_EQ(decoded.points[j], p);
  }
}

class Effort : public testing::TestWithParam<unsigned> {};

TEST_P(Effort, RoundTrip) {
  for (const Case& c : cases()) {
    for (const unsigned layers : {1U, 3U}) {
      SCOPED_TRACE(c.name + std::string(", layers: ") + std::to_string(layers));
      const TileInput tile = tileOf(c.points, GetParam(), layers);
      expectRoundTrip(tile, FastMethod().encode(tile, {}));
    }
  }
}

TEST_P(Effort, SurvivesDamage) {
  for (const Case& c : cases()) {
    for (const unsigned layers : {1U, 2U}) {
      SCOPED_TRACE(c.name + std::string(", layers: ") + std::to_string(layers));
      const std::vector<GridPoint> points(c.points.begin(), c.points.begin() + 9000);
      const TileInput tile = tileOf(points, GetParam(), layers);
      const EncodedTile coded = FastMethod().encode(tile, {});
      std::mt19937_64 random(layers);
      unsigned refused = 0;
      constexpr unsigned kTrials = 250;
      for (unsigned trial = 0; trial < kTrials; ++trial) {
        std::vector<Bytes> damaged = coded.layers;
        Bytes& layer = damaged[random() % damaged.size()];
        // The head decides most, so half of the damage is there.
        const std::size_t reach =
            trial % 2 == 0 ? layer.size() : std::min<std::size_t>(layer.size(), 100);
        for (std::uint64_t flips = 1 + random() % 3; flips > 0; --flips) {
          layer[random() % reach] = static_cast<std::uint8_t>(random());
        }
        if (trial % 8 == 0) layer.resize(random() % (layer.size() + 1));
        TileToDecode decode = toDecode(tile, damaged);
        if (trial % 16 == 0) decode.points = 1 + random() % 100000;
        if (trial % 16 == 1) decode.extent[random() % 3] = static_cast<std::uint32_t>(random());
        decode.maxPoints = 20000;
        decode.maxBytes = 1 << 24;
        try {
          const DecodedTile decoded = FastMethod().decode(decode, {});
          ASSERT_EQ(decoded.points.size(), decode.points);
          for (const GridPoint& p : decoded.points) {
            for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(p[k], decode.extent[k]);
          }
        } catch (const Error&) {
          ++refused;
        }
      }
      EXPECT_GT(refused, kTrials / 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fast, Effort, testing::Values(1U, 2U, 3U, 4U));

TEST(InputOrder, IsKeptWhereItSaysMuchAndOnlyThere) {
  const std::vector<GridPoint> inOrder = scanLines(20000);
  const TileInput tile = tileOf(inOrder, 3, 2);
  const EncodedTile coded = FastMethod().encode(tile, {});
  EXPECT_NE(coded.layers[0][0] & kInputOrderFlag, 0);
  for (std::size_t j = 0; j < coded.order.size(); ++j) ASSERT_EQ(coded.order[j], j);
  std::vector<GridPoint> shuffled = inOrder;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(2));
  const EncodedTile other = FastMethod().encode(tileOf(shuffled, 3, 2), {});
  EXPECT_EQ(other.layers[0][0] & kInputOrderFlag, 0);
}

TEST(InputOrder, LayersAreSamplesOfIt) {
  const std::vector<GridPoint> points = scanLines(20000);
  const TileInput tile = tileOf(points, 3, 3);
  const EncodedTile coded = FastMethod().encode(tile, {});
  TileToDecode coarse = toDecode(tile, coded.layers);
  coarse.payloads.pop_back();
  coarse.wantCounts = true;
  const DecodedTile decoded = FastMethod().decode(coarse, {});
  ASSERT_EQ(decoded.points.size(), coded.coarse[1].representatives);
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    GridPoint p = points[128 * i];
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    ASSERT_EQ(decoded.points[i], p);
    ASSERT_EQ(decoded.counts[i], std::min<std::size_t>(128, points.size() - 128 * i));
  }
}

TEST(SmallSets, CostLittleMoreThanTheirCounts) {
  // 200 random points of 12 bits: 36 bits each, less log2(200!) / 200 for their order.
  const std::vector<GridPoint> points = test::randomPoints(8, 200, {4095, 4095, 4095});
  const EncodedTile coded = FastMethod().encode(tileOf(points, 2, 1), {});
  const double bits = 8.0 * static_cast<double>(coded.layers[0].size()) / 200;
  EXPECT_LT(bits, 36 - std::lgamma(201.0) / std::log(2.0) / 200 + 0.75);
}

TEST(Sets, OfUnknownKindsAreRefused) {
  const fast::TileFrame frame;
  TileToDecode limits;
  limits.maxPoints = limits.maxBytes = 1 << 20;
  limits.maxDepth = 99;
  const OutputBudget budget(limits);
  DecodedTile out;
  const PointProgress silent;
  fast::PointCollector collector(frame, budget, silent, out);
  for (const unsigned kind : {3U, 9U, 16U, 0x22U, 0x71U, 0xF1U}) {
    EXPECT_THROW(
        fast::decodeSet(Bytes{static_cast<std::uint8_t>(kind), 0, 0}, 1, limits, collector), Error);
  }
  EXPECT_THROW(fast::decodeSet(Bytes{}, 1, limits, collector), Error);
}

TEST(Sets, OfSurfacesTakeFarFewerBitsThanTheirCounts) {
  const std::vector<GridPoint> points = test::scannedSphere(1, 60000, 4095);
  const std::size_t counts = KdMethod().encode(tileOf(points, 1, 1), {}).layers[0].size();
  for (const unsigned effort : {1U, 2U, 3U, 4U}) {
    const EncodedTile coded = FastMethod().encode(tileOf(points, effort, 1), {});
    EXPECT_LT(coded.layers[0].size(), counts * 9 / 10);
  }
}

TEST(Slabs, AreTheSameBytesWithAndWithoutVectors) {
  if (!fast::hasAvx2Slabs()) GTEST_SKIP() << "this processor has no AVX2";
  for (const auto& points : {test::scannedSphere(1, 20000, 4095), wideSheet(9000)}) {
    const TileInput tile = tileOf(points, 2, 1);
    const fast::RankedPoints ranked(tile);
    const fast::SetPoints set(ranked);
    for (const bool uvTree : {false, true}) {
      fast::SlabOptions options;
      options.uvTree = options.plan.compareCosts = uvTree;
      container::ByteWriter portable;
      container::ByteWriter vectors;
      const auto order = fast::writeSlabsPortable(ranked.header().frame, set, options, portable);
      EXPECT_EQ(fast::writeSlabsAvx2(ranked.header().frame, set, options, vectors), order);
      EXPECT_EQ(vectors.take(), portable.take());
    }
  }
}

TEST(Slabs, AreTheSamePointsWithAndWithoutVectors) {
  if (!fast::hasAvx2Slabs()) GTEST_SKIP() << "this processor has no AVX2";
  for (const auto& points : {test::scannedSphere(1, 20000, 4095), wideSheet(9000)}) {
    const TileInput tile = tileOf(points, 2, 1);
    const fast::RankedPoints ranked(tile);
    const fast::SetPoints set(ranked);
    const fast::TileFrame& frame = ranked.header().frame;
    for (const bool uvTree : {false, true}) {
      fast::SlabOptions options;
      options.uvTree = uvTree;
      container::ByteWriter body;
      fast::writeSlabs(frame, set, options, body);
      const Bytes bytes = body.take();
      const auto decoded = [&](auto readSlabs) {
        TileToDecode limits;
        limits.points = points.size();
        limits.maxPoints = points.size();
        limits.maxBytes = 1U << 30;
        limits.maxDepth = 99;
        const OutputBudget budget(limits);
        DecodedTile out;
        const PointProgress silent;
        fast::PointCollector collector(frame, budget, silent, out);
        readSlabs(ByteView(bytes), points.size(), uvTree, 0U, limits.maxDepth, collector);
        return out.points;
      };
      const std::vector<GridPoint> portable = decoded(fast::readSlabsPortable);
      EXPECT_EQ(decoded(fast::readSlabsAvx2), portable);
      EXPECT_EQ(portable.size(), points.size());
    }
  }
}

}  // namespace
}  // namespace bspc::geometry
