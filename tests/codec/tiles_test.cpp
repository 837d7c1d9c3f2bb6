// Files of many tiles: what tiling, threads and queries promise, whatever the method.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <thread>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

/// A sphere with a clump of duplicates, coded in tiles of 1,000 points and three layers.
class Tiles : public testing::TestWithParam<Layout> {
 protected:
  void SetUp() override {
    points_ = test::scannedSphere(11, 30000, 4095);
    points_.insert(points_.end(), 2500, points_[77]);
    file_ = test::encoded(points_, options(2));
  }

  EncodeOptions options(unsigned threads) const {
    EncodeOptions options;
    options.method = Method::Kd;
    options.tilePoints = 1000;
    options.layers = 3;
    options.layout = GetParam();
    options.threads = threads;
    return options;
  }

  std::vector<GridPoint> points_;
  Bytes file_;
};

TEST_P(Tiles, AllPointsComeBackInTheReportedOrder) {
  const std::vector<std::int32_t> xyz = test::asIntegers(points_);
  EncodeOptions wishes = options(2);
  wishes.wantOrder = true;
  EncodeReport report;
  const Bytes file = test::encoded(PointSetView(xyz.data(), points_.size()), wishes, &report);
  EXPECT_EQ(file, file_);
  EXPECT_GE(report.tiles, points_.size() / 1000);
  Decoder decoder = test::open(file);
  EXPECT_EQ(decoder.info().tiles.size(), report.tiles);
  EXPECT_EQ(decoder.info().points, points_.size());
  for (const unsigned threads : {1U, 3U}) {
    DecodeOptions decoding;
    decoding.threads = threads;
    const DecodedPoints decoded = decoder.decode(decoding);
    ASSERT_EQ(decoded.points.size(), points_.size());
    EXPECT_TRUE(decoded.complete);
    std::vector<std::int32_t> back(xyz.size());
    restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
    for (std::size_t j = 0; j < points_.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(back[3 * j + k], xyz[3 * report.order[j] + k]);
      }
    }
  }
}

TEST_P(Tiles, TheFileDoesNotDependOnTheThreads) {
  EXPECT_EQ(test::encoded(points_, options(1)), file_);
  EXPECT_EQ(test::encoded(points_, options(5)), file_);
}

TEST_P(Tiles, ABoxGivesThePointsInsideIt) {
  Decoder decoder = test::open(file_);
  DecodeOptions query;
  for (const Box& box :
       {Box{{0, 0, 0}, {5000, 5000, 5000}}, Box{{100, 2000, 300}, {900, 2600, 3000}},
        Box{{0.5, 0.5, 0.5}, {0.75, 4000, 4000}}, Box{{-9, -9, -9}, {-1, -1, -1}}}) {
    query.box = box;
    std::vector<GridPoint> expected;
    for (const GridPoint& p : points_) {
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        inside = inside && box.lower[k] <= p[k] && p[k] <= box.upper[k];
      }
      if (inside) expected.push_back(p);
    }
    const DecodedPoints decoded = decoder.decode(query);
    const Grid& grid = decoder.info().grid;
    std::vector<GridPoint> inWorld;
    for (const GridPoint& p : decoded.points) {
      GridPoint q{};
      for (std::size_t k = 0; k < 3; ++k) {
        q[k] = static_cast<std::uint32_t>(restoredCoordinate(grid, static_cast<int>(k), p[k]));
      }
      inWorld.push_back(q);
    }
    EXPECT_EQ(test::sorted(inWorld), test::sorted(expected));
    EXPECT_FALSE(decoded.complete);
  }
}

TEST_P(Tiles, ASmallBoxReadsLittle) {
  Decoder decoder = test::open(file_);
  DecodeOptions query;
  EXPECT_EQ(decoder.cost(query).tiles, decoder.info().tiles.size());
  EXPECT_EQ(decoder.cost(query).bytes, file_.size());
  query.box = Box{{0, 0, 0}, {300, 4095, 4095}};
  const QueryCost cost = decoder.cost(query);
  EXPECT_LT(cost.tiles, decoder.info().tiles.size() / 2);
  EXPECT_LT(cost.bytes, file_.size() / 2);
  EXPECT_GE(cost.points, decoder.decode(query).points.size());
}

TEST_P(Tiles, BoxesThatAreNoneAreRefused) {
  Decoder decoder = test::open(file_);
  DecodeOptions query;
  for (const double upper : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    query.box = Box{{0, 0, 0}, {10, upper, 10}};
    EXPECT_THROW(decoder.decode(query), Error);
  }
}

TEST_P(Tiles, BudgetsAreKeptAtOnceAndTileByTile) {
  Decoder decoder = test::open(file_);
  for (const std::uint64_t budget : {0U, 1U, 17U, 1000U, 5000U, 31000U, 40000U}) {
    DecodeOptions query;
    query.maxPoints = budget;
    query.wantCounts = true;
    const DecodedPoints whole = decoder.decode(query);
    EXPECT_LE(whole.points.size(), budget);
    std::uint64_t points = 0;
    decoder.decodeTiles(query, [&points](DecodedPoints&& tile) {
      EXPECT_EQ(tile.counts.size(), tile.points.size());
      points += tile.points.size();
    });
    EXPECT_LE(points, budget);
    EXPECT_GE(points + decoder.info().tiles.size(), whole.points.size());
    EXPECT_EQ(whole.complete, budget >= points_.size());
  }
}

TEST_P(Tiles, RangesOfTilesAddUpToTheWhole) {
  Decoder decoder = test::open(file_);
  DecodeOptions options;
  options.cellLevel = 1;
  options.level = 1;
  const DecodedPoints all = decoder.decode(options);
  const std::uint64_t tiles = decoder.info().tiles.size();
  DecodedPoints parts;
  for (const TileRange& range : {TileRange{0, 0}, TileRange{0, 5}, TileRange{5, tiles - 5}}) {
    options.tiles = range;
    EXPECT_EQ(decoder.cost(options).tiles, range.count);
    const DecodedPoints part = decoder.decode(options);
    EXPECT_FALSE(part.complete);
    parts.points.insert(parts.points.end(), part.points.begin(), part.points.end());
    parts.cellIds.insert(parts.cellIds.end(), part.cellIds.begin(), part.cellIds.end());
  }
  EXPECT_EQ(parts.points, all.points);
  EXPECT_EQ(parts.cellIds, all.cellIds);
  for (const TileRange& range : {TileRange{tiles + 1, 0}, TileRange{0, tiles + 1},
                                 TileRange{1, tiles}, TileRange{2, ~std::uint64_t{0}}}) {
    options.tiles = range;
    EXPECT_THROW(decoder.decode(options), Error);
  }
}

TEST_P(Tiles, CountsOfALevelAddUpOverTheTiles) {
  Decoder decoder = test::open(file_);
  for (unsigned level = 0; level < 3; ++level) {
    DecodeOptions query;
    query.level = level;
    query.wantCounts = true;
    const DecodedPoints decoded = decoder.decode(query);
    EXPECT_EQ(decoded.points.size(), decoder.info().layers[level].points);
    std::uint64_t sum = 0;
    for (const std::uint64_t count : decoded.counts) sum += count;
    EXPECT_EQ(sum, points_.size());
  }
}

TEST_P(Tiles, CellsOfALevelAreThoseOfItsRepresentatives) {
  Decoder decoder = test::open(file_);
  DecodeOptions query;
  query.level = 1;
  query.wantCounts = true;
  query.cellLevel = 1;
  const DecodedPoints coarse = decoder.decode(query);
  query.level.reset();
  const DecodedPoints all = decoder.decode(query);
  std::map<std::uint64_t, std::uint64_t> sizes;
  for (const std::uint64_t id : all.cellIds) ++sizes[id];
  ASSERT_EQ(sizes.size(), coarse.points.size());
  for (std::size_t i = 0; i < coarse.points.size(); ++i) {
    EXPECT_EQ(coarse.cellIds[i], i);
    EXPECT_EQ(sizes[i], coarse.counts[i]);
  }
}

TEST_P(Tiles, CallbacksComeOnTheCallersThreadAndStopIt) {
  const auto caller = std::this_thread::get_id();
  EncodeOptions wishes = options(3);
  double last = 0;
  wishes.progress = [&](double share) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  test::encoded(points_, wishes);
  EXPECT_EQ(last, 1);
  Decoder decoder = test::open(file_);
  for (const double until : {0.0, 0.3, 0.9}) {
    DecodeOptions query;
    query.threads = 3;
    query.progress = [&](double share) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      return share < until;
    };
    try {
      decoder.decode(query);
      FAIL() << "did not stop";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
  }
}

TEST_P(Tiles, DamageOfATileIsFoundAndNamed) {
  Bytes damaged = file_;
  damaged[damaged.size() / 2] ^= 1;
  Decoder decoder = test::open(damaged);
  try {
    decoder.decode();
    FAIL() << "was not found";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Corrupt);
    EXPECT_NE(std::string(error.what()).find("tile"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, Tiles, testing::Values(Layout::Progressive, Layout::Streaming));

}  // namespace
}  // namespace bspc
