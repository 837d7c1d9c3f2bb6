#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "entropy/symbol_coder.h"
#include "geometry/geometry_method.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

constexpr std::uint32_t kInt32Top = 0x7FFFFFFF;

/// Of the grid that the points' box spans.
unsigned gridBits(const std::vector<GridPoint>& points) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(),
                            [k](const GridPoint& a, const GridPoint& b) { return a[k] < b[k]; });
    bits = std::max(bits, entropy::bitLength((*most)[k] - (*least)[k]));
  }
  return bits;
}

TEST(RoundTrip, EverySetInEveryLayoutAndMethod) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    for (const Method method : availableMethods()) {
      for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
        SCOPED_TRACE(set.name);
        std::vector<std::uint32_t> xyz;
        for (const GridPoint& p : set.points) xyz.insert(xyz.end(), p.begin(), p.end());
        EncodeOptions options;
        options.method = method;
        options.layout = layout;
        options.wantOrder = true;
        EncodeReport report;
        const PointSetView points(xyz.data(), ScalarType::UInt32, set.points.size(), 0);
        Bytes file;
        try {
          file = test::encoded(points, options, &report);
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::Unsupported) << error.what();
          EXPECT_GT(gridBits(set.points), geometry::findGeometryMethod(method)->maxBits());
          continue;
        }
        EXPECT_TRUE(report.exact);
        EXPECT_EQ(report.fileBytes, file.size());
        Decoder decoder = test::open(file);
        const DecodedPoints decoded = decoder.decode();
        ASSERT_EQ(decoded.points.size(), set.points.size());
        EXPECT_TRUE(decoded.complete);
        std::vector<std::uint32_t> back(3 * decoded.points.size());
        restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
        for (std::size_t j = 0; j < set.points.size(); ++j) {
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(back[3 * j + k], set.points[report.order[j]][k]);
          }
        }
      }
    }
  }
}

TEST(RoundTrip, AnEmptySetIsAFile) {
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    EncodeOptions options;
    options.layout = layout;
    const Bytes file = test::encoded(std::vector<GridPoint>(), options);
    Decoder decoder = test::open(file);
    EXPECT_EQ(decoder.info().points, 0U);
    const DecodedPoints decoded = decoder.decode();
    EXPECT_TRUE(decoded.points.empty());
    EXPECT_TRUE(decoded.complete);
  }
}

TEST(RoundTrip, OrderSkipsDroppedPoints) {
  std::vector<double> xyz;
  for (unsigned i = 0; i < 300; ++i) {
    xyz.insert(xyz.end(), {i * 0.5, i % 7 == 3 ? std::nan("") : 1.0, 250.0 - i});
  }
  EncodeOptions options;
  options.grid.dropNonFinite = true;
  options.wantOrder = true;
  EncodeReport report;
  const Bytes file = test::encoded(PointSetView(xyz.data(), 300), options, &report);
  EXPECT_EQ(report.dropped, 43U);
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  ASSERT_EQ(decoded.points.size(), 257U);
  std::vector<double> back(3 * decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  for (std::size_t j = 0; j < 257; ++j) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(back[3 * j + k], xyz[3 * report.order[j] + k]);
  }
}

TEST(RoundTrip, StrideSkipsWhatIsNotAPosition) {
  struct Vertex {
    std::uint8_t colour[4];
    float position[3];
    float weight;
  };
  std::vector<Vertex> vertices;
  for (unsigned i = 0; i < 100; ++i) {
    vertices.push_back({{1, 2, 3, 4}, {static_cast<float>(i), 2.0F, 3.0F}, 9.0F});
  }
  const Bytes file =
      test::encoded(PointSetView(vertices[0].position, ScalarType::Float32, 100, sizeof(Vertex)));
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  std::vector<float> back(300);
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  std::vector<float> x;
  for (std::size_t j = 0; j < 100; ++j) {
    x.push_back(back[3 * j]);
    EXPECT_EQ(back[3 * j + 1], 2.0F);
    EXPECT_EQ(back[3 * j + 2], 3.0F);
  }
  std::sort(x.begin(), x.end());
  for (std::size_t j = 0; j < 100; ++j) EXPECT_EQ(x[j], static_cast<float>(j));
}

TEST(LevelOfDetail, CountsAddUpAndCellsHoldThem) {
  const std::vector<GridPoint> points = test::scannedSphere(1, 30000, kInt32Top);
  EncodeOptions encoding;
  encoding.method = Method::Kd;
  const Bytes file = test::encoded(points, encoding);
  Decoder decoder = test::open(file);
  const FileInfo& info = decoder.info();
  ASSERT_GT(info.layers.size(), 2U);
  for (unsigned level = 0; level < info.layers.size(); ++level) {
    DecodeOptions options;
    options.level = level;
    options.wantCounts = true;
    const DecodedPoints decoded = decoder.decode(options);
    EXPECT_EQ(decoded.points.size(), info.layers[level].points);
    EXPECT_EQ(decoded.complete, level + 1 == info.layers.size());
    std::uint64_t sum = 0;
    for (const std::uint64_t c : decoded.counts) sum += c;
    EXPECT_EQ(sum, points.size());
  }
  EXPECT_LT(info.layers[0].points, 1000U);
  EXPECT_EQ(info.layers.back().points, points.size());
}

TEST(LevelOfDetail, ABudgetIsKeptAndUsed) {
  const std::vector<GridPoint> points = test::scannedSphere(2, 30000, 65535);
  const Bytes file = test::encoded(points);
  Decoder decoder = test::open(file);
  for (const std::uint64_t budget :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{10}, std::uint64_t{1000},
        std::uint64_t{29999}, std::uint64_t{30000}, std::uint64_t{1} << 40}) {
    DecodeOptions options;
    options.maxPoints = budget;
    options.wantCounts = true;
    const DecodedPoints decoded = decoder.decode(options);
    EXPECT_LE(decoded.points.size(), budget);
    EXPECT_GE(decoded.points.size(), std::min<std::uint64_t>(budget / 10, points.size()));
    EXPECT_EQ(decoded.complete, budget >= points.size());
    std::uint64_t sum = 0;
    for (const std::uint64_t c : decoded.counts) sum += c;
    EXPECT_EQ(sum, budget == 0 ? 0 : points.size());
  }
}

TEST(LevelOfDetail, ImpossibleWishesAreErrors) {
  const std::vector<GridPoint> points = test::scannedSphere(3, 5000, 65535);
  const Bytes file = test::encoded(points);
  Decoder decoder = test::open(file);
  DecodeOptions options;
  options.level = 99;
  EXPECT_THROW(decoder.decode(options), Error);
  options.level = 0;
  options.cellLevel = 1;
  EXPECT_THROW(decoder.decode(options), Error);
}

TEST(Progress, RisesToOneAndCanStop) {
  const std::vector<GridPoint> points = test::scannedSphere(4, 200000, 65535);
  const std::vector<std::int32_t> xyz = test::asIntegers(points);
  double last = 0;
  EncodeOptions options;
  options.progress = [&last](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  };
  const Bytes file = test::encoded(PointSetView(xyz.data(), points.size()), options);
  EXPECT_EQ(last, 1);

  options.progress = [](double share) { return share < 0.5; };
  MemorySink sink;
  try {
    encode(PointSetView(xyz.data(), points.size()), sink, options);
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }

  Decoder decoder = test::open(file);
  DecodeOptions decoding;
  unsigned calls = 0;
  decoding.progress = [&calls](double) { return ++calls < 3; };
  try {
    decoder.decode(decoding);
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(Overhead, OfOneTileIsAtMost64Bytes) {
  std::mt19937_64 random(9);
  for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{4000}}) {
    std::vector<float> narrow;
    std::vector<double> wide;
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const double x = static_cast<double>(random() >> 11) * 0x1p-53 * 100 - 20;
      narrow.push_back(static_cast<float>(x));
      wide.push_back(std::round(x * 1000) / 1000 + 7000000);
    }
    const auto overhead = [](const PointSetView& points, const GridRequest& grid) {
      EncodeOptions options;
      options.grid = grid;
      EncodeReport report;
      test::encoded(points, options, &report);
      return report.fileBytes - report.geometryBytes;
    };
    const PointSetView floats(narrow.data(), count);
    const PointSetView doubles(wide.data(), count);
    EXPECT_LE(overhead(floats, GridRequest::automatic()), 64U);
    EXPECT_LE(overhead(floats, GridRequest::withBits(12)), 64U);
    EXPECT_LE(overhead(floats, GridRequest::withPrecision(0.01)), 64U);
    EXPECT_LE(overhead(doubles, GridRequest::automatic()), 64U);
    EXPECT_LE(overhead(doubles, GridRequest::withBits(12)), 64U);
    EXPECT_LE(overhead(doubles, GridRequest::withPrecision(0.01)), 64U);
  }
}

TEST(Output, DoesNotDependOnTheRun) {
  const std::vector<GridPoint> points = test::scannedSphere(5, 20000, 4095);
  EXPECT_EQ(test::encoded(points), test::encoded(points));
}

}  // namespace
}  // namespace bspc
