#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "bspc/error.h"
#include "geometry/predictive/predictive_method.h"
#include "support/point_sets.h"
#include "support/tiles.h"

namespace bspc::geometry {
namespace {

std::size_t bytesOf(const EncodedTile& tile) {
  std::size_t bytes = 0;
  for (const Bytes& layer : tile.layers) bytes += layer.size();
  return bytes;
}

TileToDecode decodable(const TileInput& tile, const EncodedTile& coded) {
  TileToDecode whole;
  whole.points = tile.points.size();
  whole.extent = tile.extent;
  whole.layers = tile.layers;
  for (const Bytes& layer : coded.layers) whole.payloads.push_back(layer);
  whole.maxPoints = 10 * whole.points;
  whole.maxBytes = std::uint64_t{1} << 30;
  whole.maxDepth = 96;
  return whole;
}

/// Codes the points, checks that they come back in the order told, and returns the coded tile.
EncodedTile roundTrip(const std::vector<GridPoint>& points, unsigned layers) {
  const TileInput tile = test::tileOf(points, layers);
  const PredictiveMethod method;
  EncodedTile coded = method.encode(tile, {});
  const DecodedTile decoded = method.decode(decodable(tile, coded), {});
  EXPECT_EQ(decoded.points.size(), points.size());
  EXPECT_EQ(coded.order.size(), points.size());
  if (decoded.points.size() != points.size() || coded.order.size() != points.size()) return coded;
  std::vector<bool> used(points.size());
  for (std::size_t j = 0; j < points.size(); ++j) {
    const std::uint32_t i = coded.order[j];
    EXPECT_FALSE(used[i]);
    used[i] = true;
    for (unsigned k = 0; k < 3; ++k) {
      EXPECT_EQ(decoded.points[j][k] + tile.lower[k], points[i][k]) << j;
    }
  }
  return coded;
}

/// Random points with their images in `planes` planes across x and y, and a few without.
std::vector<GridPoint> mirrored(std::size_t count, unsigned planes) {
  std::mt19937_64 random(31);
  std::vector<GridPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({static_cast<std::uint32_t>(random() % 2000),
                      static_cast<std::uint32_t>(random() % 2000),
                      static_cast<std::uint32_t>(random() % 4000)});
  }
  for (unsigned axis = 0; axis < planes; ++axis) {
    const std::size_t half = points.size();
    for (std::size_t i = 0; i < half; ++i) {
      if (i % 20 == 7) continue;
      GridPoint p = points[i];
      p[axis] = 4001 - p[axis];
      points.push_back(p);
    }
  }
  for (std::size_t i = 0; i < 10; ++i) points.push_back(points[7 * i]);  // duplicates
  points.push_back({3000, 100, 4000});
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

/// A depth camera's view of a wavy wall with holes, and two points that it does not see.
std::vector<GridPoint> wall() {
  std::mt19937_64 random(17);
  std::vector<GridPoint> points;
  for (int v = -45; v < 45; ++v) {
    for (int u = -60; u < 60; ++u) {
      if (random() % 30 == 0) continue;
      const int rank = static_cast<int>(30 + 0.3 * u + 0.2 * v + 3 * std::sin(0.1 * u));
      const double z = 700 + 17.0 * rank;
      points.push_back({static_cast<std::uint32_t>(std::lround(u * z / 100 + 1500)),
                        static_cast<std::uint32_t>(std::lround(v * z / 100 + 1500)),
                        static_cast<std::uint32_t>(z)});
    }
  }
  points.push_back({1499, 1502, 1203});
  points.push_back({1, 2, 1111});
  return points;
}

TEST(PredictiveStructure, MirroredHalfCostsLittle) {
  const std::vector<GridPoint> points = mirrored(600, 1);
  const std::size_t whole = bytesOf(roundTrip(points, 1));
  const std::size_t half = bytesOf(roundTrip(mirrored(600, 0), 1));
  EXPECT_LT(whole, half + half / 5);
}

TEST(PredictiveStructure, TwoPlanesAreUsed) {
  const std::size_t quarters = bytesOf(roundTrip(mirrored(500, 2), 1));
  const std::size_t quarter = bytesOf(roundTrip(mirrored(500, 0), 1));
  EXPECT_LT(quarters, quarter + quarter / 2);
}

TEST(PredictiveStructure, RangeImageCostsLessThanPoints) {
  const std::vector<GridPoint> points = wall();
  const std::size_t bytes = bytesOf(roundTrip(points, 1));
  EXPECT_LT(8 * bytes, 2 * points.size());
}

TEST(PredictiveStructure, CoarseLayersHaveOneCell) {
  for (const std::vector<GridPoint>& points : {mirrored(600, 1), wall()}) {
    const EncodedTile coded = roundTrip(points, 3);
    ASSERT_EQ(coded.coarse.size(), 2U);
    EXPECT_EQ(coded.coarse[0].representatives, 1U);
    EXPECT_EQ(coded.coarse[1].representatives, 1U);
    const TileInput tile = test::tileOf(points, 3);
    TileToDecode first = decodable(tile, coded);
    first.payloads.resize(1);
    first.wantCounts = true;
    const DecodedTile decoded = PredictiveMethod().decode(first, {});
    ASSERT_EQ(decoded.points.size(), 1U);
    EXPECT_EQ(decoded.counts[0], points.size());
  }
}

TEST(PredictiveStructure, PointsKeepTheCellOfACoarseLayer) {
  const std::vector<GridPoint> points = mirrored(600, 1);
  const TileInput tile = test::tileOf(points, 2);
  const EncodedTile coded = PredictiveMethod().encode(tile, {});
  TileToDecode whole = decodable(tile, coded);
  for (const unsigned level : {0U, 1U}) {
    whole.cellLevel = level;
    const DecodedTile decoded = PredictiveMethod().decode(whole, {});
    ASSERT_EQ(decoded.cellIds.size(), points.size());
    const auto [least, most] = std::minmax_element(decoded.cellIds.begin(), decoded.cellIds.end());
    EXPECT_EQ(*least, 0U);
    EXPECT_EQ(*most > 0, level == 1);
  }
}

TEST(PredictiveStructure, LatticesOfAxesAreUsed) {
  std::mt19937_64 random(3);
  std::vector<GridPoint> aligned;
  std::vector<GridPoint> free;
  for (int i = 0; i < 1500; ++i) {
    GridPoint p{};
    for (std::uint32_t& x : p) x = static_cast<std::uint32_t>(std::lround(random() % 300 * 11.7));
    aligned.push_back(p);
    for (std::uint32_t& x : p) x += static_cast<std::uint32_t>(random() % 11);
    free.push_back(p);
  }
  const std::size_t some = bytesOf(roundTrip(aligned, 1));
  const std::size_t all = bytesOf(roundTrip(free, 1));
  EXPECT_LT(some, all * 4 / 5);
}

TEST(PredictiveStructure, DamagedTilesGivePointsOrAnError) {
  std::mt19937_64 random(8);
  unsigned errors = 0;
  for (const std::vector<GridPoint>& points : {mirrored(60, 2), wall()}) {
    const TileInput tile = test::tileOf(points, 1);
    const EncodedTile coded = PredictiveMethod().encode(tile, {});
    for (int round = 0; round < 40; ++round) {
      Bytes damaged = coded.layers[0];
      const std::size_t reach =
          round % 2 == 0 ? std::min<std::size_t>(64, damaged.size()) : damaged.size();
      damaged[random() % reach] ^= static_cast<std::uint8_t>(1U << (random() % 8));
      TileToDecode whole = decodable(tile, coded);
      whole.payloads = {damaged};
      try {
        const DecodedTile decoded = PredictiveMethod().decode(whole, {});
        EXPECT_EQ(decoded.points.size(), points.size());
        for (const GridPoint& p : decoded.points) {
          for (unsigned k = 0; k < 3; ++k) ASSERT_LE(p[k], tile.extent[k]);
        }
      } catch (const Error& e) {
        EXPECT_NE(e.code(), ErrorCode::InvalidArgument);
        ++errors;
      }
    }
  }
  EXPECT_GT(errors, 20U);
}

}  // namespace
}  // namespace bspc::geometry
