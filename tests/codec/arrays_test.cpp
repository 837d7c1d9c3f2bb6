// Named arrays beside the positions, through encode() and Decoder.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <set>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

/// A point set with arrays, which it owns.
class SetWithArrays {
 public:
  SetWithArrays(const std::vector<GridPoint>& points, std::vector<ArrayValues> arrays)
      : xyz_(test::asIntegers(points)), arrays_(std::move(arrays)) {}

  PointSetView view() const {
    PointSetView view(xyz_.data(), xyz_.size() / 3);
    for (const ArrayValues& array : arrays_) view.addArray(array.view());
    return view;
  }
  const std::vector<ArrayValues>& arrays() const { return arrays_; }
  std::array<std::int32_t, 3> point(std::size_t i) const {
    return {xyz_[3 * i], xyz_[3 * i + 1], xyz_[3 * i + 2]};
  }
  std::size_t size() const { return xyz_.size() / 3; }

 private:
  std::vector<std::int32_t> xyz_;
  std::vector<ArrayValues> arrays_;
};

SetWithArrays scan(std::size_t points = 2000) {
  return {test::scannedSphere(5, points, 2047), test::arraysOfAllTypes(points)};
}

std::array<std::int32_t, 3> restored(const Grid& grid, const GridPoint& p) {
  std::array<std::int32_t, 3> xyz{};
  restorePositions(grid, Span<const GridPoint>(&p, 1), xyz.data());
  return xyz;
}

/// Point and all its tuples, as one comparable thing.
using Row = std::pair<std::array<std::int32_t, 3>, std::string>;

std::vector<Row> rowsOf(const SetWithArrays& set) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < set.size(); ++i) {
    std::string tuples;
    for (const ArrayValues& array : set.arrays()) tuples += test::tupleOf(array, i);
    rows.emplace_back(set.point(i), tuples);
  }
  return rows;
}

std::vector<Row> rowsOf(const Grid& grid, const DecodedPoints& decoded) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    std::string tuples;
    for (const ArrayValues& array : decoded.arrays) tuples += test::tupleOf(array, i);
    rows.emplace_back(restored(grid, decoded.points[i]), tuples);
  }
  return rows;
}

std::vector<Row> sortedRows(std::vector<Row> rows) {
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<Row> decodedRows(const Bytes& file, const DecodeOptions& options = {}) {
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode(options);
  return rowsOf(decoder.info().grid, decoded);
}

struct Case {
  std::string name;
  Method method;
  unsigned layers;
  std::uint64_t tilePoints;
  Layout layout;
  bool keepOrder;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Arrays : public testing::TestWithParam<Case> {
 protected:
  EncodeOptions options() const {
    EncodeOptions options;
    options.method = GetParam().method;
    options.layers = GetParam().layers;
    options.tilePoints = GetParam().tilePoints;
    options.layout = GetParam().layout;
    options.keepOrder = GetParam().keepOrder;
    return options;
  }
};

TEST_P(Arrays, OfEveryTypeComeBackWithTheirPoints) {
  const SetWithArrays set = scan();
  EncodeReport report;
  const Bytes file = test::encoded(set.view(), options(), &report);
  std::vector<Row> decoded = decodedRows(file);
  if (GetParam().keepOrder) {
    EXPECT_EQ(decoded, rowsOf(set));
  } else {
    EXPECT_EQ(sortedRows(std::move(decoded)), sortedRows(rowsOf(set)));
  }
  ASSERT_EQ(report.arrays.size(), set.arrays().size());
  std::uint64_t bytes = 0;
  for (const ArrayReport& array : report.arrays) bytes += array.bytes;
  EXPECT_GT(bytes, set.size());
  EXPECT_LT(report.geometryBytes + report.orderBytes + bytes, report.fileBytes);
}

TEST_P(Arrays, DoNotDependOnTheNumberOfThreads) {
  const SetWithArrays set = scan();
  EncodeOptions one = options();
  one.threads = 1;
  EncodeOptions many = options();
  many.threads = 5;
  const Bytes file = test::encoded(set.view(), one);
  EXPECT_EQ(file, test::encoded(set.view(), many));
  DecodeOptions decoding;
  decoding.threads = 1;
  const std::vector<Row> rows = decodedRows(file, decoding);
  decoding.threads = 5;
  EXPECT_EQ(rows, decodedRows(file, decoding));
}

TEST_P(Arrays, OfABoxAreThoseOfItsPoints) {
  const SetWithArrays set = scan();
  const Bytes file = test::encoded(set.view(), options());
  DecodeOptions query;
  query.box = Box{{100, 200, 0}, {1500, 1100, 3000}};
  std::vector<Row> expected;
  for (Row& row : rowsOf(set)) {
    const auto& p = row.first;
    if (100 <= p[0] && p[0] <= 1500 && 200 <= p[1] && p[1] <= 1100) expected.push_back(row);
  }
  ASSERT_FALSE(expected.empty());
  const std::vector<Row> decoded = decodedRows(file, query);
  if (GetParam().keepOrder) {
    EXPECT_EQ(decoded, expected);
  } else {
    EXPECT_EQ(sortedRows(decoded), sortedRows(expected));
  }
}

TEST_P(Arrays, OfCoarseLevelsAreThoseOfTheirPoints) {
  const SetWithArrays set = scan();
  const Bytes file = test::encoded(set.view(), options());
  Decoder decoder = test::open(file);
  const std::vector<Row> all = rowsOf(set);
  const std::set<Row> known(all.begin(), all.end());
  const unsigned first = decoder.info().arrays.at(0).firstLevel;
  EXPECT_EQ(first, GetParam().method == Method::Fast ? 0 : GetParam().layers - 1);
  for (unsigned level = 0; level < GetParam().layers; ++level) {
    DecodeOptions query;
    query.level = level;
    query.wantCounts = true;
    const DecodedPoints decoded = decoder.decode(query);
    if (level < first) {
      EXPECT_TRUE(decoded.arrays.empty());
      continue;
    }
    ASSERT_EQ(decoded.arrays.size(), set.arrays().size());
    for (const Row& row : rowsOf(decoder.info().grid, decoded)) ASSERT_EQ(known.count(row), 1U);
  }
}

TEST_P(Arrays, ThatAreNotAskedForAreNotRead) {
  const SetWithArrays set = scan();
  const Bytes file = test::encoded(set.view(), options());
  Decoder decoder = test::open(file);
  DecodeOptions query;
  const std::uint64_t all = decoder.cost(query).bytes;
  EXPECT_EQ(all, file.size());
  query.arrays = std::vector<std::string>{"int16", "bit"};
  const DecodedPoints two = decoder.decode(query);
  const std::uint64_t some = decoder.cost(query).bytes;
  ASSERT_EQ(two.arrays.size(), 2U);
  EXPECT_EQ(two.arrays[0].name, "int16");
  EXPECT_EQ(two.arrays[1].name, "bit");
  query.arrays = std::vector<std::string>{};
  EXPECT_TRUE(decoder.decode(query).arrays.empty());
  const std::uint64_t none = decoder.cost(query).bytes;
  EXPECT_LT(none, some);
  EXPECT_LT(some, all);
  std::uint64_t payload = 0;
  for (const ArrayInfo& array : decoder.info().arrays) payload += array.bytes;
  EXPECT_LT(payload, all - none);
}

TEST_P(Arrays, AreThinnedWithTheirPoints) {
  const SetWithArrays set = scan();
  EncodeOptions encoding = options();
  encoding.layers = 1;
  const Bytes file = test::encoded(set.view(), encoding);
  DecodeOptions query;
  query.maxPoints = 100;
  const std::vector<Row> all = rowsOf(set);
  const std::set<Row> known(all.begin(), all.end());
  const std::vector<Row> thinned = decodedRows(file, query);
  EXPECT_EQ(thinned.size(), 100U);
  for (const Row& row : thinned) EXPECT_EQ(known.count(row), 1U);
}

TEST_P(Arrays, ComeTileByTileToo) {
  const SetWithArrays set = scan();
  const Bytes file = test::encoded(set.view(), options());
  Decoder decoder = test::open(file);
  std::vector<Row> rows;
  decoder.decodeTiles({}, [&](DecodedPoints&& points) {
    const std::vector<Row> more = rowsOf(decoder.info().grid, points);
    rows.insert(rows.end(), more.begin(), more.end());
  });
  EXPECT_EQ(rows, decodedRows(file));
}

INSTANTIATE_TEST_SUITE_P(
    Methods, Arrays,
    testing::Values(Case{"fast", Method::Fast, 1, 0, Layout::Progressive, false},
                    Case{"fastTiles", Method::Fast, 3, 700, Layout::Progressive, false},
                    Case{"fastStreaming", Method::Fast, 2, 700, Layout::Streaming, false},
                    Case{"fastOrdered", Method::Fast, 1, 0, Layout::Progressive, true},
                    Case{"fastOrderedTiles", Method::Fast, 3, 700, Layout::Streaming, true},
                    Case{"kd", Method::Kd, 3, 0, Layout::Progressive, false},
                    Case{"kdOrderedTiles", Method::Kd, 2, 900, Layout::Progressive, true},
                    Case{"bsp", Method::Bsp, 2, 0, Layout::Progressive, false}),
    [](const auto& c) { return c.param.name; });

ErrorCode encodingError(const PointSetView& view, const EncodeOptions& options = {}) {
  MemorySink sink;
  try {
    encode(view, sink, options);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "the arrays were accepted";
  return ErrorCode::Io;
}

TEST(ArrayChecks, RefuseWhatMakesNoSense) {
  const std::vector<std::int32_t> xyz{1, 2, 3, 4, 5, 6};
  const std::vector<float> values{1, 2};
  ArrayView good;
  good.name = "a";
  good.tuples = 2;
  good.data = values.data();
  const auto error = [&](const std::function<void(ArrayView&)>& change, bool twice = false) {
    PointSetView view(xyz.data(), 2);
    ArrayView bad = good;
    change(bad);
    view.addArray(bad);
    if (twice) view.addArray(bad);
    return encodingError(view);
  };
  EXPECT_EQ(error([](ArrayView& a) { a.name = ""; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.tuples = 1; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.components = 0; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.strideBytes = 3; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.data = nullptr; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.tolerance = -1; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) { a.componentNames = {"x", "y"}; }), ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView& a) {
              a.type = ScalarType::Int32;
              a.tolerance = 1;
            }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(error([](ArrayView&) {}, true), ErrorCode::InvalidArgument);
}

TEST(ArrayChecks, AnArrayThatTheFileHasNotIsNamed) {
  const Bytes file = test::encoded(scan(100).view());
  DecodeOptions query;
  query.arrays = std::vector<std::string>{"colour"};
  try {
    test::open(file).decode(query);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("\"colour\""), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("uint16"), std::string::npos);
  }
}

TEST(ArrayTable, SaysAgainWhatItWasTold) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  const std::vector<float> xyz{0, 0, 0, 1, 1, 1};
  ArrayView array;
  array.name = "Flow";
  array.components = 3;
  array.componentNames = {"u", "", "w"};
  array.unit = "m/s";
  array.semantic = Semantic::Scalars;
  array.tuples = 2;
  array.data = values.data();
  PointSetView view(xyz.data(), 2);
  view.addArray(array);
  const Bytes file = test::encoded(view);
  const Decoder decoder = test::open(file);
  const ArrayInfo& info = decoder.info().arrays.at(0);
  EXPECT_EQ(info.name, "Flow");
  EXPECT_EQ(info.components, 3U);
  EXPECT_EQ(info.componentNames, array.componentNames);
  EXPECT_EQ(info.unit, "m/s");
  EXPECT_EQ(info.semantic, Semantic::Scalars);
  EXPECT_EQ(info.type, ScalarType::Float32);
}

TEST(ArrayTable, FilesWithoutArraysHaveNone) {
  EXPECT_TRUE(test::open(test::encoded(test::scannedSphere(1, 50, 99))).info().arrays.empty());
}

TEST(Arrays, OfAnEmptySetAreThereWithoutValues) {
  PointSetView view(static_cast<const float*>(nullptr), 0);
  ArrayView array;
  array.name = "a";
  view.addArray(array);
  const Bytes file = test::encoded(view);
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  ASSERT_EQ(decoded.arrays.size(), 1U);
  EXPECT_EQ(decoded.arrays[0].name, "a");
  EXPECT_EQ(decoded.arrays[0].tuples(), 0U);
}

TEST(Arrays, MayBeInterleavedWithPositions) {
  struct Vertex {
    float xyz[3];
    std::uint8_t colour[4];
  };
  std::vector<Vertex> vertices;
  for (std::uint8_t i = 0; i < 100; ++i) {
    vertices.push_back(
        {{float(i % 7), float(i % 11), float(i)}, {i, static_cast<std::uint8_t>(2 * i), 7, 255}});
  }
  PointSetView view(vertices.data(), ScalarType::Float32, vertices.size(), sizeof(Vertex));
  ArrayView colours;
  colours.name = "Colours";
  colours.type = ScalarType::UInt8;
  colours.components = 3;
  colours.tuples = vertices.size();
  colours.data = vertices[0].colour;
  colours.strideBytes = sizeof(Vertex);
  view.addArray(colours);
  const Bytes file = test::encoded(view);
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    const auto z =
        static_cast<std::uint8_t>(restoredCoordinate(decoder.info().grid, 2, decoded.points[i][2]));
    EXPECT_EQ(test::tupleOf(decoded.arrays[0], i),
              (std::string{static_cast<char>(z), static_cast<char>(2 * z), 7}));
  }
}

TEST(Arrays, TuplesOfDroppedPointsAreDroppedWithThem) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> xyz{0, 0, 0, nan, 0, 0, 2, 0, 0, 0, nan, 0, 3, 0, 0};
  const std::vector<std::uint16_t> values{10, 11, 12, 13, 14};
  PointSetView view(xyz.data(), 5);
  ArrayView array;
  array.name = "v";
  array.type = ScalarType::UInt16;
  array.tuples = 5;
  array.data = values.data();
  view.addArray(array);
  EncodeOptions options;
  options.grid.dropNonFinite = true;
  options.keepOrder = true;
  options.originalIds = true;
  const Bytes file = test::encoded(view, options);
  const DecodedPoints decoded = test::open(file).decode();
  ASSERT_EQ(decoded.arrays.size(), 2U);
  const std::uint16_t* kept =
      reinterpret_cast<const std::uint16_t*>(decoded.arrays[0].values.data());
  EXPECT_EQ(std::vector<std::uint16_t>(kept, kept + 3), (std::vector<std::uint16_t>{10, 12, 14}));
  EXPECT_EQ(decoded.arrays[1].name, "OriginalPointIds");
  EXPECT_EQ(decoded.arrays[1].semantic, Semantic::Ids);
  std::vector<std::uint64_t> ids(3);
  std::memcpy(ids.data(), decoded.arrays[1].values.data(), 24);
  EXPECT_EQ(ids, (std::vector<std::uint64_t>{0, 2, 4}));
}

TEST(Arrays, FollowPointsThatALossyCodingMoves) {
  const SetWithArrays set = scan(500);
  EncodeOptions options;
  options.method = Method::Kd;
  options.stopPoints = 5;
  options.originalIds = true;
  const Bytes file = test::encoded(set.view(), options);
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  ASSERT_EQ(decoded.points.size(), set.size());
  std::vector<std::uint64_t> ids(set.size());
  std::memcpy(ids.data(), decoded.arrays.back().values.data(), 8 * ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t a = 0; a < set.arrays().size(); ++a) {
      ASSERT_EQ(test::tupleOf(decoded.arrays[a], i), test::tupleOf(set.arrays()[a], ids[i]));
    }
  }
}

/// Scan lines of a lattice, with the time at which each point was taken.
SetWithArrays timedScan(bool inOrder) {
  constexpr std::size_t kSide = 60;
  std::vector<GridPoint> points;
  ArrayValues time;
  time.name = "time";
  time.type = ScalarType::Float64;
  std::mt19937_64 random(8);
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      points.push_back({x * 10 + y % 3, y * 10, static_cast<std::uint32_t>(random() % 5)});
      const std::size_t i = inOrder ? y * kSide + x : random();
      const double t = 270000 + static_cast<double>(i) * 1.2207e-4;
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(&t);
      time.values.insert(time.values.end(), bytes, bytes + sizeof t);
    }
  }
  return {points, {time}};
}

TEST(Arrays, ThatFollowTheInputBringItsOrderIntoTheFile) {
  EncodeOptions options;
  options.method = Method::Kd;
  EncodeReport report;
  const SetWithArrays inOrder = timedScan(true);
  const Bytes file = test::encoded(inOrder.view(), options, &report);
  EXPECT_GT(report.orderBytes, 0U);
  EXPECT_EQ(test::open(file).info().orderBytes, report.orderBytes);
  EXPECT_FALSE(test::open(file).info().keepsOrder);
  EXPECT_LT(report.orderBytes + report.arrays[0].bytes, inOrder.size() * 3);
  EXPECT_EQ(sortedRows(decodedRows(file)), sortedRows(rowsOf(inOrder)));
  // Who reads no array reads no order.
  DecodeOptions points;
  points.arrays = std::vector<std::string>{};
  EXPECT_LT(test::open(file).cost(points).bytes, file.size() - report.orderBytes);

  const SetWithArrays shuffled = timedScan(false);
  test::encoded(shuffled.view(), options, &report);
  EXPECT_EQ(report.orderBytes, 0U);
}

TEST(Metadata, ComesBackAsItWas) {
  EncodeOptions options;
  options.metadata.crs = "EPSG:25832";
  options.metadata.lengthUnit = "m";
  options.metadata.entries = {{"title", "Häuser"}, {"empty", ""}};
  options.metadata.fieldData = test::arraysOfAllTypes(7);
  const Bytes file = test::encoded(test::scannedSphere(1, 50, 99), options);
  const Decoder decoder = test::open(file);
  const Metadata& metadata = decoder.info().metadata;
  EXPECT_EQ(metadata.crs, options.metadata.crs);
  EXPECT_EQ(metadata.lengthUnit, "m");
  EXPECT_EQ(metadata.entries, options.metadata.entries);
  ASSERT_EQ(metadata.fieldData.size(), options.metadata.fieldData.size());
  for (std::size_t a = 0; a < metadata.fieldData.size(); ++a) {
    EXPECT_EQ(metadata.fieldData[a].name, options.metadata.fieldData[a].name);
    EXPECT_EQ(metadata.fieldData[a].values, options.metadata.fieldData[a].values);
    EXPECT_EQ(metadata.fieldData[a].strings, options.metadata.fieldData[a].strings);
  }
}

TEST(Metadata, KeysComeOnce) {
  EncodeOptions options;
  options.metadata.entries = {{"a", "1"}, {"a", "2"}};
  const std::vector<float> xyz{0, 0, 0};
  EXPECT_EQ(encodingError(PointSetView(xyz.data(), 1), options), ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace bspc
