#include "attributes/array_coder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "attributes/array_samples.h"
#include "attributes/float_bytes.h"
#include "bspc/error.h"
#include "support/point_sets.h"

namespace bspc::attributes {
namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 34;

/// The input index of each point, as a scanner that sweeps along x would have it.
std::vector<std::uint32_t> sweep(const std::vector<GridPoint>& points) {
  std::vector<std::uint32_t> sorted(points.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::stable_sort(sorted.begin(), sorted.end(), [&points](std::uint32_t a, std::uint32_t b) {
    return points[a][0] / 64 != points[b][0] / 64 ? points[a][0] < points[b][0]
                                                  : points[a][1] < points[b][1];
  });
  std::vector<std::uint32_t> order(points.size());
  for (std::uint32_t t = 0; t < sorted.size(); ++t) order[sorted[t]] = t;
  return order;
}

void expectRoundTrip(const test::SampleArray& array, const std::vector<GridPoint>& points,
                     std::size_t known, unsigned effort, const std::vector<std::uint32_t>& order) {
  TilePoints forEncoder(points, known);
  TilePoints forDecoder(points, known);
  if (!order.empty()) {
    forEncoder.setInputOrder(order);
  }
  ArrayValues given = array.values;
  ArrayWishes wishes;
  wishes.effort = effort;
  const EncodedArray encoded = encodeArray(array.shape, given, forEncoder, wishes);
  EXPECT_EQ(encoded.greatestError, 0);
  EXPECT_EQ(given.numbers, array.values.numbers) << "lossless coding changed the values";
  if (encoded.usesInputOrder) forDecoder.setInputOrder(order);
  ArrayValues back = test::firstTuples(array, known);
  decodeArray(array.shape, encoded.payload, forDecoder, kPlenty, back);
  EXPECT_EQ(back.numbers, array.values.numbers)
      << array.name << " at effort " << effort << ", method " << unsigned{encoded.payload[0]};
  EXPECT_EQ(back.strings, array.values.strings) << array.name << " at effort " << effort;
}

TEST(ArrayCoder, EveryTypeComesBackBitForBit) {
  const std::vector<GridPoint> points = test::scannedSphere(1, 400, 2000);
  for (const test::SampleArray& array : test::sampleArrays(points, 1)) {
    for (const unsigned effort : {1U, 3U, 5U, 9U}) {
      expectRoundTrip(array, points, 0, effort, {});
    }
  }
}

TEST(ArrayCoder, KnownPointsOfCoarserLayersAreUsed) {
  const std::vector<GridPoint> points = test::scannedSphere(2, 300, 3000);
  for (const test::SampleArray& array : test::sampleArrays(points, 2)) {
    for (const std::size_t known : {std::size_t{1}, std::size_t{100}, points.size() - 1}) {
      for (const unsigned effort : {2U, 9U}) expectRoundTrip(array, points, known, effort, {});
    }
  }
}

TEST(ArrayCoder, TheOrderOfTheInputIsUsed) {
  const std::vector<GridPoint> points = test::scannedSphere(3, 800, 3000);
  const std::vector<std::uint32_t> order = sweep(points);
  for (const test::SampleArray& array : test::sampleArrays(points, 3)) {
    for (const unsigned effort : {2U, 7U}) expectRoundTrip(array, points, 0, effort, order);
  }
}

TEST(ArrayCoder, QuickEffortsTellCategoriesAlongTheInput) {
  const std::vector<GridPoint> points = test::scannedSphere(5, 400, 20000);
  const std::vector<std::uint32_t> order = sweep(points);
  test::SampleArray returns{"returns", {ScalarType::UInt8}, {}};
  returns.values.numbers.resize(points.size());
  std::mt19937 random(1);
  std::vector<std::uint8_t> along;  // pulses of one to three returns
  while (along.size() < points.size()) {
    const auto pulse = static_cast<std::uint8_t>(1 + random() % 3);
    along.insert(along.end(), pulse, pulse);
  }
  for (std::size_t i = 0; i < points.size(); ++i) returns.values.numbers[i] = along[order[i]];
  std::array<std::size_t, 3> sizes{};
  for (const unsigned effort : {1U, 2U}) {
    expectRoundTrip(returns, points, 0, effort, order);
    TilePoints known(points);
    known.setInputOrder(order);
    ArrayWishes wishes;
    wishes.effort = effort;
    sizes[effort] = encodeArray(returns.shape, returns.values, known, wishes).payload.size();
  }
  EXPECT_LT(sizes[2], sizes[1] * 9 / 10);
}

TEST(ArrayCoder, DegenerateSetsComeBack) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    std::vector<GridPoint> points = set.points;
    if (points.empty()) continue;
    points.resize(std::min<std::size_t>(points.size(), 60));
    for (const test::SampleArray& array : test::sampleArrays(points, 4)) {
      SCOPED_TRACE(set.name);
      expectRoundTrip(array, points, 0, 2, {});
      expectRoundTrip(array, points, points.size() / 2, 8, {});
    }
  }
}

TEST(ArrayCoder, SamplesOfLargeArraysChooseMethodsThatComeBack) {
  const std::vector<GridPoint> points = test::scannedSphere(5, 26000, 4000);
  const std::vector<std::uint32_t> order = sweep(points);
  for (const test::SampleArray& array : test::sampleArrays(points, 5)) {
    if (array.name != "colours" && array.name != "time" && array.name != "normals") continue;
    expectRoundTrip(array, points, 0, 3, {});
    expectRoundTrip(array, points, 0, 6, order);
  }
}

TEST(ArrayCoder, NothingNewIsNoBytes) {
  const std::vector<GridPoint> points = test::scannedSphere(6, 10, 100);
  test::SampleArray array = test::sampleNormals(points);
  TilePoints tile(points, points.size());
  EXPECT_TRUE(encodeArray(array.shape, array.values, tile, {}).payload.empty());
  ArrayValues back = array.values;
  decodeArray(array.shape, {}, tile, kPlenty, back);
  EXPECT_EQ(back.numbers, array.values.numbers);
}

TEST(ArrayCoder, RandomNumbersCostHardlyMoreThanTheirBytes) {
  const std::vector<GridPoint> points = test::scannedSphere(7, 2000, 4000);
  std::mt19937_64 random(7);
  test::SampleArray array{"random", {ScalarType::UInt32, 1, Semantic::None}, {}};
  for (std::size_t i = 0; i < 4 * points.size(); ++i) {
    array.values.numbers.push_back(static_cast<std::uint8_t>(random()));
  }
  for (const unsigned effort : {1U, 9U}) {
    TilePoints tile(points);
    ArrayWishes wishes;
    wishes.effort = effort;
    EXPECT_LE(encodeArray(array.shape, array.values, tile, wishes).payload.size(),
              array.values.numbers.size() + 16);
  }
}

TEST(ArrayCoder, SmoothNumbersCostLessThanAGeneralCompressorWouldTake) {
  const std::vector<GridPoint> points = test::scannedSphere(8, 4000, 4000);
  for (test::SampleArray& array : test::sampleArrays(points, 8)) {
    if (array.name != "normals" && array.name != "smooth float32") continue;
    TilePoints tile(points);
    ArrayWishes wishes;
    wishes.effort = 7;
    const std::size_t size = encodeArray(array.shape, array.values, tile, wishes).payload.size();
    EXPECT_LT(8 * size, 22 * array.values.numbers.size() / 4) << array.name;
  }
}

TEST(ArrayCoder, AnErrorBoundHoldsAndIsReported) {
  const std::vector<GridPoint> points = test::scannedSphere(9, 2000, 4000);
  for (const test::SampleArray& array : test::sampleArrays(points, 9)) {
    if (!isFloatingPoint(array.shape.type)) continue;
    for (const double bound : {1e-1, 1e-3, 1e-9}) {
      for (const unsigned effort : {2U, 6U}) {
        TilePoints tile(points, 500);
        ArrayValues given = array.values;
        ArrayWishes wishes;
        wishes.effort = effort;
        wishes.maxError = bound;
        const EncodedArray encoded = encodeArray(array.shape, given, tile, wishes);
        ArrayValues back = test::firstTuples(array, 500);
        decodeArray(array.shape, encoded.payload, tile, kPlenty, back);
        ASSERT_EQ(back.numbers, given.numbers) << "the encoder tells what comes back";
        double greatest = 0;
        const std::size_t size = scalarSize(array.shape.type);
        for (std::size_t at = 0; at < given.numbers.size(); at += size) {
          const double wanted = readFloat(array.values.numbers.data() + at, array.shape.type);
          const double got = readFloat(given.numbers.data() + at, array.shape.type);
          if (std::isfinite(wanted)) {
            greatest = std::max(greatest, std::fabs(got - wanted));
          } else {
            ASSERT_EQ(
                std::memcmp(array.values.numbers.data() + at, given.numbers.data() + at, size), 0);
          }
        }
        EXPECT_LE(greatest, bound) << array.name;
        EXPECT_LE(std::fabs(greatest - encoded.greatestError), 1e-12) << array.name;
      }
    }
  }
}

TEST(ArrayCoder, NormalsKeepTheirAngle) {
  const std::vector<GridPoint> points = test::scannedSphere(10, 2000, 4000);
  test::SampleArray array = test::sampleNormals(points);
  const float none = 0;
  constexpr std::ptrdiff_t kTuple = 12;
  constexpr std::ptrdiff_t kBegin = kTuple * 700;
  std::memcpy(array.values.numbers.data() + kBegin, &none, sizeof none);  // not of length one
  for (const double angle : {5.0, 0.2, 0.001}) {
    for (const unsigned effort : {2U, 6U}) {
      TilePoints tile(points, 300);
      ArrayValues given = array.values;
      ArrayWishes wishes;
      wishes.effort = effort;
      wishes.maxAngle = angle;
      const EncodedArray encoded = encodeArray(array.shape, given, tile, wishes);
      EXPECT_LE(encoded.greatestError, angle);
      EXPECT_GT(encoded.greatestError, 0.8 * angle) << "places are as far apart as they may be";
      ArrayValues back = test::firstTuples(array, 300);
      decodeArray(array.shape, encoded.payload, tile, kPlenty, back);
      ASSERT_EQ(back.numbers, given.numbers);
      EXPECT_TRUE(std::equal(back.numbers.begin() + kBegin, back.numbers.begin() + kBegin + kTuple,
                             array.values.numbers.begin() + kBegin));
      for (std::size_t i = 300; i < points.size(); ++i) {
        if (i == 700) continue;
        double product = 0;
        double length = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = 4 * (3 * i + c);
          const double a = readFloat(array.values.numbers.data() + at, ScalarType::Float32);
          const double b = readFloat(back.numbers.data() + at, ScalarType::Float32);
          product += a * b;
          length += b * b;
        }
        ASSERT_NEAR(length, 1, 1e-6);
        ASSERT_GE(product, std::cos((angle + 0.03) / 57.29577951308232)) << i;
      }
    }
  }
}

TEST(ArrayCoder, WrongCountsAreRefused) {
  const std::vector<GridPoint> points = test::scannedSphere(11, 100, 1000);
  test::SampleArray array = test::sampleNormals(points);
  array.values.numbers.pop_back();
  TilePoints tile(points);
  EXPECT_THROW(encodeArray(array.shape, array.values, tile, {}), Error);
  const std::vector<std::uint32_t> twice(points.size(), 5);
  EXPECT_THROW(tile.setInputOrder(twice), Error);
  const std::vector<std::uint32_t> tooShort(points.size() - 1, 5);
  EXPECT_THROW(tile.setInputOrder(tooShort), Error);
}

TEST(ArrayCoder, MemoryStaysWithinTheLimit) {
  const std::vector<GridPoint> points = test::scannedSphere(12, 500, 4000);
  for (test::SampleArray& array : test::sampleArrays(points, 12)) {
    TilePoints tile(points);
    ArrayWishes wishes;
    wishes.effort = 6;
    const EncodedArray encoded = encodeArray(array.shape, array.values, tile, wishes);
    try {
      TilePoints other(points);
      ArrayValues back;
      decodeArray(array.shape, encoded.payload, other, 1000, back);
      FAIL() << array.name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::LimitExceeded) << array.name;
    }
  }
}

}  // namespace
}  // namespace bspc::attributes
