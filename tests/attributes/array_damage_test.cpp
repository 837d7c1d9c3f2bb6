#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <string>

#include "attributes/array_coder.h"
#include "attributes/array_samples.h"
#include "attributes/order_coder.h"
#include "attributes/ordered_words.h"
#include "bspc/error.h"
#include "support/point_sets.h"

namespace bspc::attributes {
namespace {

constexpr std::uint64_t kLimit = 64U << 20;

Bytes damaged(const Bytes& payload, std::mt19937_64& random) {
  Bytes bytes = payload;
  const auto place = [&bytes, &random] {
    return static_cast<std::size_t>(random() % bytes.size());
  };
  switch (random() % 4) {
    case 0:
      bytes[place()] ^= static_cast<std::uint8_t>(1U << random() % 8);
      break;
    case 1:
      bytes.resize(place());
      break;
    case 2:
      for (unsigned i = 0; i < 4; ++i) bytes[place()] = static_cast<std::uint8_t>(random());
      break;
    default:  // the front holds the settings
      bytes[random() % std::min<std::size_t>(bytes.size(), 12)] =
          static_cast<std::uint8_t>(random());
  }
  return bytes;
}

/// Any bytes give an error of the expected kinds, or values for all points.
void expectSafe(const ArrayShape& shape, const Bytes& payload, const std::vector<GridPoint>& points,
                const std::vector<std::uint32_t>& order, const ArrayValues& known,
                std::size_t knownTuples) {
  TilePoints tile(points, knownTuples);
  if (!order.empty()) tile.setInputOrder(order);
  ArrayValues values = known;
  try {
    decodeArray(shape, payload, tile, kLimit, values);
    const std::size_t count = points.size() * shape.components;
    if (shape.type == ScalarType::String) {
      EXPECT_EQ(values.strings.size(), count);
    } else {
      EXPECT_EQ(values.numbers.size(), count * numberSize(shape.type));
    }
  } catch (const Error& error) {
    EXPECT_TRUE(error.code() == ErrorCode::Corrupt || error.code() == ErrorCode::Unsupported ||
                error.code() == ErrorCode::LimitExceeded)
        << error.what();
  }
}

TEST(ArrayDamage, MutatedPayloadsAreErrorsOrValues) {
  const std::vector<GridPoint> points = test::scannedSphere(21, 200, 2000);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.rbegin(), order.rend(), 0U);
  std::mt19937_64 random(21);
  for (const test::SampleArray& array : test::sampleArrays(points, 21)) {
    for (const unsigned effort : {2U, 6U}) {
      for (const double loss : {0.0, 1e-2}) {
        if (loss > 0 && !isFloatingPoint(array.shape.type)) continue;
        TilePoints tile(points, 50);
        const bool useOrder = effort == 6;
        const std::vector<std::uint32_t> newOrder(order.begin() + 50, order.end());
        if (useOrder) tile.setInputOrder(newOrder);
        ArrayValues values = array.values;
        ArrayWishes wishes;
        wishes.effort = effort;
        wishes.maxError = loss;
        wishes.maxAngle = 10 * loss;
        const Bytes payload = encodeArray(array.shape, values, tile, wishes).payload;
        const ArrayValues known = test::firstTuples(array, 50);
        for (unsigned i = 0; i < 40; ++i) {
          expectSafe(array.shape, damaged(payload, random), points,
                     useOrder ? newOrder : std::vector<std::uint32_t>{}, known, 50);
        }
      }
    }
  }
}

TEST(ArrayDamage, RandomBytesBehindEveryMethodAreErrorsOrValues) {
  const std::vector<GridPoint> points = test::scannedSphere(22, 200, 2000);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937_64 random(22);
  for (const test::SampleArray& array : test::sampleArrays(points, 22)) {
    for (unsigned method = 0; method < 10; ++method) {
      for (unsigned i = 0; i < 12; ++i) {
        Bytes payload(random() % 900 + 1);
        for (std::uint8_t& b : payload) b = static_cast<std::uint8_t>(random());
        payload[0] = static_cast<std::uint8_t>(method);
        if (payload.size() > 1) payload[1] &= 0x7F;
        expectSafe(array.shape, payload, points, order, {}, 0);
      }
    }
  }
}

TEST(ArrayDamage, TheOrderOfTheInputIsAskedFor) {
  const std::vector<GridPoint> points = test::scannedSphere(23, 20, 2000);
  TilePoints tile(points);
  ArrayValues values;
  const Bytes payload{1, 1, 0, 7};  // method Bytes in the order of the input, equal bytes
  const ArrayShape shape{ScalarType::UInt8, 1, Semantic::None};
  try {
    decodeArray(shape, payload, tile, kLimit, values);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Corrupt);
  }
}

TEST(ArrayDamage, PlacesOfExceptionsTakeNoMoreMemoryThanTheyMay) {
  const std::vector<GridPoint> points = test::scannedSphere(25, 20, 2000);
  const ArrayShape normals{ScalarType::Float32, 3, Semantic::Normals};
  // Method Sphere of size 100 with one exception, whose place is said to take 2^25 equal bytes.
  const Bytes payload{8, 100, 1, 0x80, 0x80, 0x80, 0x10, 0, 0};
  TilePoints tile(points);
  ArrayValues values;
  try {
    decodeArray(normals, payload, tile, kLimit, values);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Corrupt);
    EXPECT_NE(std::string(error.what()).find("too many bytes"), std::string::npos);
  }
}

TEST(OrderDamage, MutatedPayloadsAreErrorsOrPermutations) {
  const std::vector<GridPoint> points = test::scannedSphere(24, 600, 1000);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937_64 random(24);
  for (unsigned round = 0; round < 2; ++round) {
    const Bytes payload = encodeOrder(points, order);
    for (unsigned i = 0; i < 400; ++i) {
      Bytes bytes = damaged(payload, random);
      if (i % 3 == 0) {
        for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
        if (!bytes.empty()) bytes[0] = static_cast<std::uint8_t>(1 + random() % 2);
        if (bytes.size() > 1) bytes[1] = static_cast<std::uint8_t>(4 + random() % 3);
      }
      try {
        std::vector<std::uint32_t> back = decodeOrder(points, bytes, kLimit);
        ASSERT_EQ(back.size(), points.size());
        std::sort(back.begin(), back.end());
        for (std::uint32_t k = 0; k < back.size(); ++k) ASSERT_EQ(back[k], k);
      } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::Corrupt || error.code() == ErrorCode::Unsupported);
      }
    }
    std::shuffle(order.begin(), order.end(), random);
  }
}

}  // namespace
}  // namespace bspc::attributes
