// Lossy coding: cells that stay undivided, and what the encoder says about it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

class LossyMethod : public testing::TestWithParam<Method> {};

struct Coded {
  EncodeReport report;
  Bytes file;
  DecodedPoints decoded;
};

Coded code(const std::vector<GridPoint>& points, const EncodeOptions& options) {
  Coded coded;
  const std::vector<std::int32_t> xyz = test::asIntegers(points);
  coded.file = test::encoded(PointSetView(xyz.data(), points.size()), options, &coded.report);
  Decoder decoder = test::open(coded.file);
  DecodeOptions wish;
  wish.cellLevel = coded.report.layers - 1;
  coded.decoded = decoder.decode(wish);
  // Integer coordinates stand on a grid of step 1 from the least ones.
  for (GridPoint& p : coded.decoded.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<std::uint32_t>(decoder.info().grid.coordinate(static_cast<int>(k), p[k]));
    }
  }
  return coded;
}

/// Greatest distance along each axis of the points to what they came back as.
std::array<double, 3> errors(const std::vector<GridPoint>& points, const Coded& coded) {
  std::array<double, 3> most{};
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = static_cast<double>(coded.decoded.points[j][k]) -
                       static_cast<double>(points[coded.report.order[j]][k]);
      most[k] = std::max(most[k], std::abs(d));
    }
  }
  return most;
}

TEST_P(LossyMethod, EveryPointComesBackOnceAndTheReportTellsTheError) {
  const std::vector<GridPoint> points = test::scannedSphere(21, 6000, 4095);
  for (const unsigned layers : {1U, 3U}) {
    for (const std::uint64_t stop : {1U, 4U, 100U, 6000U}) {
      SCOPED_TRACE(std::to_string(layers) + " layers, stop at " + std::to_string(stop));
      EncodeOptions options;
      options.method = GetParam();
      options.layers = layers;
      options.stopPoints = stop;
      options.wantOrder = true;
      const Coded coded = code(points, options);
      ASSERT_EQ(coded.decoded.points.size(), points.size());
      EXPECT_FALSE(coded.report.exact);
      EXPECT_EQ(coded.report.maxError, errors(points, coded));
      std::vector<std::uint64_t> order = coded.report.order;
      std::sort(order.begin(), order.end());
      for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
    }
  }
}

TEST_P(LossyMethod, CellsHaveAtMostAsManyPointsAsTheyMayOrAreWhole) {
  const std::vector<GridPoint> points = test::scannedSphere(22, 5000, 4095);
  EncodeOptions options;
  options.method = GetParam();
  options.layers = 1;
  options.stopPoints = 20;
  const Coded coded = code(points, options);
  std::map<std::uint64_t, std::uint64_t> cells;
  for (const std::uint64_t id : coded.decoded.cellIds) ++cells[id];
  EXPECT_LT(cells.size(), points.size() / 4);
  EXPECT_GT(cells.size(), points.size() / 20);
  for (const auto& [id, count] : cells) EXPECT_LE(count, 20U) << "cell " << id;
}

TEST_P(LossyMethod, ALevelMoreIsSmallerErrorAndMoreBytes) {
  const std::vector<GridPoint> points = test::scannedSphere(23, 5000, 4095);
  double lastError = 1e9;
  std::size_t lastBytes = 0;
  for (unsigned level = 0; level <= 40; level += 5) {
    EncodeOptions options;
    options.method = GetParam();
    options.layers = 1;
    options.stopLevel = level;
    options.wantOrder = true;
    const Coded coded = code(points, options);
    const std::array<double, 3> error = errors(points, coded);
    const double sum = std::accumulate(error.begin(), error.end(), 0.0);
    EXPECT_LE(sum, lastError) << "level " << level;
    EXPECT_GE(coded.file.size(), lastBytes) << "level " << level;
    if (level == 0) {
      EXPECT_EQ(std::count(coded.decoded.points.begin(), coded.decoded.points.end(),
                           coded.decoded.points[0]),
                5000);
    }
    lastError = sum;
    lastBytes = coded.file.size();
  }
  EXPECT_LT(lastError, 30);
}

TEST_P(LossyMethod, StopsThatStopNothingAreExact) {
  const std::vector<GridPoint> points = test::scannedSphere(24, 3000, 4095);
  EncodeOptions options;
  options.method = GetParam();
  options.stopLevel = 900;
  options.wantOrder = true;
  const Coded coded = code(points, options);
  EXPECT_TRUE(coded.report.exact);
  EXPECT_EQ(errors(points, coded), (std::array<double, 3>{}));
}

INSTANTIATE_TEST_SUITE_P(Codec, LossyMethod, testing::Values(Method::Kd, Method::Bsp),
                         [](const auto& method) { return methodName(method.param); });

TEST(Lossy, ErrorsAreThoseOfTheDataIncludingTheGrid) {
  std::vector<double> xyz;
  for (unsigned i = 0; i < 3000; ++i) xyz.push_back(std::sin(i * 1.7) * 10);
  EncodeOptions options;
  options.method = Method::Bsp;
  options.grid = GridRequest::withPrecision(0.01);
  options.stopPoints = 3;
  options.wantOrder = true;
  EncodeReport report;
  const Bytes file = test::encoded(PointSetView(xyz.data(), 1000), options, &report);
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  std::vector<double> back(3000);
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  std::array<double, 3> most{};
  for (std::size_t j = 0; j < 1000; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      most[k] = std::max(most[k], std::abs(back[3 * j + k] - xyz[3 * report.order[j] + k]));
    }
  }
  EXPECT_EQ(report.maxError, most);
}

TEST(Lossy, MethodsWithoutStopsSaySo) {
  const std::vector<GridPoint> points = test::scannedSphere(25, 100, 4095);
  for (const Method method : {Method::Octree, Method::GenCode}) {
    EncodeOptions options;
    options.method = method;
    options.stopPoints = 3;
    try {
      test::encoded(points, options);
      FAIL() << "the wish was dropped";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    }
  }
}

}  // namespace
}  // namespace bspc
