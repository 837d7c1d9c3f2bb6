#include "bspc/join.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

std::vector<std::array<double, 3>> coordinates(const Bytes& file, unsigned level) {
  Decoder decoder = test::open(file);
  DecodeOptions options;
  options.level = level;
  const DecodedPoints decoded = decoder.decode(options);
  std::vector<std::array<double, 3>> xyz(decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), xyz[0].data());
  std::sort(xyz.begin(), xyz.end());
  return xyz;
}

Bytes joined(const std::vector<Bytes>& files, Layout layout, JoinReport* report = nullptr) {
  std::vector<std::shared_ptr<ByteSource>> sources;
  sources.reserve(files.size());
  for (const Bytes& file : files) sources.push_back(std::make_shared<MemorySource>(file));
  MemorySink sink;
  JoinOptions options;
  options.layout = layout;
  const JoinReport r = join(sources, sink, options);
  if (report != nullptr) *report = r;
  return sink.take();
}

/// Doubles on a lattice of 0.01, moved by `shift`; the grid is that of `like` if there is one.
Bytes scan(std::uint64_t seed, double shift, unsigned layers, std::uint64_t tilePoints,
           const Bytes* like, Layout layout = Layout::Progressive) {
  std::vector<double> xyz;
  for (const GridPoint& p : test::scannedSphere(seed, 5000, 4095)) {
    for (const std::uint32_t v : p) xyz.push_back((v + shift) / 100);
  }
  EncodeOptions options;
  options.method = Method::Kd;
  options.layers = layers;
  options.tilePoints = tilePoints;
  options.layout = layout;
  if (like != nullptr) options.grid = GridRequest::onGrid(test::open(*like).info().grid);
  return test::encoded(PointSetView(xyz.data(), xyz.size() / 3), options);
}

TEST(Join, HoldsAllPointsWhereverTheyLie) {
  const Bytes a = scan(1, 0, 2, 0, nullptr);
  const Bytes b = scan(2, -100000, 2, 900, &a, Layout::Streaming);
  const Bytes c = scan(3, 70000, 2, 2000, &a);
  std::vector<std::array<double, 3>> expected = coordinates(a, 1);
  for (const Bytes* file : {&b, &c}) {
    const auto more = coordinates(*file, 1);
    expected.insert(expected.end(), more.begin(), more.end());
  }
  std::sort(expected.begin(), expected.end());
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    JoinReport report;
    const Bytes file = joined({a, b, c}, layout, &report);
    EXPECT_EQ(report.points, 15000U);
    EXPECT_EQ(report.fileBytes, file.size());
    EXPECT_EQ(coordinates(file, 1), expected);
    // Joined files can be joined again.
    EXPECT_EQ(coordinates(joined({file}, layout), 1), expected);
  }
}

TEST(Join, TilesOfFewerLayersBeginAtAFinerLevel) {
  const Bytes one = scan(1, 0, 1, 0, nullptr);
  const Bytes four = scan(2, 0, 4, 0, &one);
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    const Bytes file = joined({one, four}, layout);
    Decoder decoder = test::open(file);
    Decoder alone = test::open(four);
    ASSERT_EQ(decoder.info().layers.size(), 4U);
    for (unsigned level = 0; level < 3; ++level) {
      EXPECT_EQ(decoder.info().layers[level].points, alone.info().layers[level].points + 1);
      DecodeOptions options;
      options.level = level;
      options.wantCounts = true;
      options.cellLevel = level;
      const DecodedPoints coarse = decoder.decode(options);
      EXPECT_EQ(coarse.points.size(), decoder.info().layers[level].points);
      EXPECT_EQ(coarse.counts[0], 5000U);
      EXPECT_EQ(coarse.cellIds[0], 0U);
      EXPECT_EQ(coarse.cellIds.back() + 1, coarse.points.size());
      // The one that stands for the whole tile is as near as the index says.
      const TileInfo& tile = decoder.info().tiles[0];
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(coarse.points[0][k] - tile.lower[k], decoder.info().layers[level].spread);
        EXPECT_LE(tile.upper[k] - coarse.points[0][k], decoder.info().layers[level].spread);
      }
      options.level = 3;
      const DecodedPoints all = decoder.decode(options);
      EXPECT_EQ(all.points.size(), 10000U);
      EXPECT_EQ(std::count(all.cellIds.begin(), all.cellIds.end(), 0U), 5000);
    }
  }
}

TEST(Join, OtherGridsAreRefusedByNumber) {
  const Bytes a = scan(1, 0, 1, 0, nullptr);
  std::vector<GridPoint> points = test::randomPoints(4, 100, {1000, 1000, 1000});
  const Bytes other = test::encoded(points);
  try {
    joined({a, a, other}, Layout::Progressive);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("file 2"), std::string::npos) << error.what();
  }
  EXPECT_THROW(joined({}, Layout::Progressive), Error);
}

TEST(Join, EmptyFilesJoinWithAny) {
  const Bytes a = scan(1, 0, 1, 0, nullptr);
  const Bytes empty = test::encoded(std::vector<GridPoint>());
  EXPECT_EQ(coordinates(joined({empty, a, empty}, Layout::Progressive), 0), coordinates(a, 0));
  EXPECT_EQ(test::open(joined({empty, empty}, Layout::Streaming)).info().points, 0U);
}

TEST(Join, DamageIsNotCopied) {
  const Bytes a = scan(1, 0, 1, 0, nullptr);
  Bytes damaged = a;
  damaged[damaged.size() - 100] ^= 1;
  EXPECT_THROW(joined({a, damaged}, Layout::Progressive), Error);
}

TEST(Join, ExtentsBeyondTheGridAreRefused) {
  const Bytes a = scan(1, 0, 1, 0, nullptr);
  const Bytes far = scan(2, 4294967000.0, 1, 0, &a);
  try {
    joined({a, far}, Layout::Progressive);
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::OutOfGrid);
  }
}

/// A few points on whole numbers with arrays and metadata.
Bytes withArrays(const std::vector<ArrayValues>& arrays, EncodeOptions options = {}) {
  std::vector<std::int32_t> xyz;
  const std::size_t count = static_cast<std::size_t>(arrays.at(0).tuples());
  for (std::size_t i = 0; i < count; ++i) {
    const auto v = static_cast<std::int32_t>(i);
    xyz.insert(xyz.end(), {v % 7, v % 31, v});
  }
  PointSetView view(xyz.data(), count);
  for (const ArrayValues& array : arrays) view.addArray(array.view());
  options.grid = GridRequest::withPrecision(1);
  return test::encoded(view, options);
}

/// Tuples of the arrays by name, of every point, sorted.
std::vector<std::string> sortedTuples(const Bytes& file) {
  const DecodedPoints decoded = test::open(file).decode();
  std::map<std::string, const ArrayValues*> byName;
  for (const ArrayValues& array : decoded.arrays) byName[array.name] = &array;
  std::vector<std::string> tuples;
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    std::string tuple;
    for (const auto& [name, array] : byName) tuple += test::tupleOf(*array, i);
    tuples.push_back(std::move(tuple));
  }
  std::sort(tuples.begin(), tuples.end());
  return tuples;
}

std::string joinError(const std::vector<Bytes>& files) {
  try {
    joined(files, Layout::Progressive);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    return error.what();
  }
  ADD_FAILURE() << "the files were joined";
  return {};
}

TEST(Join, BringsArraysTogetherByName) {
  const auto colour = [](std::uint64_t seed) {
    return test::randomArray("colour", ScalarType::UInt8, 3, 500, seed);
  };
  const auto time = [](std::uint64_t seed) {
    return test::randomArray("time", ScalarType::Float64, 1, 500, seed);
  };
  EncodeOptions layered;
  layered.layers = 3;
  layered.tilePoints = 200;
  EncodeOptions ordered;
  ordered.keepOrder = true;
  ordered.method = Method::Kd;
  ordered.layout = Layout::Streaming;
  const Bytes a = withArrays({colour(1), time(2)}, layered);
  const Bytes b = withArrays({time(3), colour(4)}, ordered);
  std::vector<std::string> expected = sortedTuples(a);
  for (const std::string& tuple : sortedTuples(b)) expected.push_back(tuple);
  std::sort(expected.begin(), expected.end());
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    const Bytes both = joined({a, b}, layout);
    EXPECT_EQ(sortedTuples(both), expected);
    EXPECT_FALSE(test::open(both).info().keepsOrder);
    EXPECT_EQ(test::open(both).info().arrays[0].firstLevel, 2U);
  }
  const Bytes twice = joined({b, b}, Layout::Progressive);
  EXPECT_TRUE(test::open(twice).info().keepsOrder);
  const DecodedPoints decoded = test::open(twice).decode();
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(decoded.points[i][2], i % 500);
}

TEST(Join, NamesTheArrayThatIsMissingOrOther) {
  const ArrayValues colour = test::randomArray("colour", ScalarType::UInt8, 3, 50, 1);
  const ArrayValues time = test::randomArray("time", ScalarType::Float64, 1, 50, 1);
  const ArrayValues floats = test::randomArray("time", ScalarType::Float32, 1, 50, 1);
  const Bytes both = withArrays({colour, time});
  EXPECT_NE(joinError({both, withArrays({colour})}).find("\"time\""), std::string::npos);
  EXPECT_NE(joinError({withArrays({colour}), both}).find("\"time\""), std::string::npos);
  EXPECT_NE(joinError({both, withArrays({colour, floats})}).find("1 x float32"), std::string::npos);
}

TEST(Join, BringsMetadataTogether) {
  const ArrayValues array = test::randomArray("a", ScalarType::UInt8, 1, 20, 1);
  EncodeOptions one;
  one.metadata.crs = "EPSG:25832";
  one.metadata.entries = {{"title", "north"}, {"source", "scan"}};
  EncodeOptions two;
  two.metadata.lengthUnit = "m";
  two.metadata.entries = {{"title", "south"}, {"date", "2026"}, {"source", "scan"}};
  JoinReport report;
  const Bytes file =
      joined({withArrays({array}, one), withArrays({array}, two)}, Layout::Progressive, &report);
  const Metadata metadata = test::open(file).info().metadata;
  EXPECT_EQ(metadata.crs, "EPSG:25832");
  EXPECT_EQ(metadata.lengthUnit, "m");
  EXPECT_EQ(metadata.entries.size(), 3U);
  EXPECT_EQ(report.droppedMetadata, std::vector<std::string>{"file 1: title"});
  two.metadata.crs = "EPSG:4326";
  EXPECT_NE(joinError({withArrays({array}, one), withArrays({array}, two)}).find("EPSG:4326"),
            std::string::npos);
}

}  // namespace
}  // namespace bspc
