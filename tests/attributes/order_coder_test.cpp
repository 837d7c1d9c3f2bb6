#include "attributes/order_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "attributes/morton.h"
#include "attributes/unused_set.h"
#include "bspc/error.h"
#include "support/point_sets.h"

namespace bspc::attributes {
namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 32;

std::size_t expectRoundTrip(const std::vector<GridPoint>& points,
                            const std::vector<std::uint32_t>& order) {
  const Bytes payload = encodeOrder(points, order);
  EXPECT_EQ(decodeOrder(points, payload, kPlenty), order);
  return payload.size();
}

/// Points of a scanner that sweeps over a plane to and fro, in the order of a Morton curve, with
/// their input indices.
void scanLines(std::size_t lines, std::vector<GridPoint>& points,
               std::vector<std::uint32_t>& order) {
  std::vector<GridPoint> input;
  std::mt19937_64 random(1);
  for (std::size_t y = 0; y < lines; ++y) {
    for (std::size_t x = 0; x < lines; ++x) {
      const std::size_t along = y % 2 == 0 ? x : lines - 1 - x;
      input.push_back({static_cast<std::uint32_t>(10 * along + random() % 3),
                       static_cast<std::uint32_t>(10 * y + random() % 3),
                       static_cast<std::uint32_t>(random() % 4)});
    }
  }
  for (const MortonEntry& e : mortonOrder(input, coordinateBits(input))) {
    points.push_back(input[e.index]);
    order.push_back(e.index);
  }
}

TEST(OrderCoder, ScanLinesCostFewBits) {
  std::vector<GridPoint> points;
  std::vector<std::uint32_t> order;
  scanLines(80, points, order);
  EXPECT_LT(8 * expectRoundTrip(points, order), 2 * points.size());
}

TEST(OrderCoder, ShuffledPointsCostTheLogarithmOfAllOrders) {
  const std::vector<GridPoint> points = test::scannedSphere(31, 3000, 4000);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(31));
  const double least = std::lgamma(static_cast<double>(points.size()) + 1) / std::log(2.0);
  EXPECT_LT(static_cast<double>(8 * expectRoundTrip(points, order)), least + 200);
}

TEST(OrderCoder, TheDecodedOrderItselfIsOneByte) {
  const std::vector<GridPoint> points = test::scannedSphere(32, 100, 4000);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  EXPECT_EQ(expectRoundTrip(points, order), 1U);
  EXPECT_EQ(expectRoundTrip({}, {}), 0U);
}

TEST(OrderCoder, DegenerateSetsComeBack) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    SCOPED_TRACE(set.name);
    std::vector<GridPoint> points = set.points;
    points.resize(std::min<std::size_t>(points.size(), 1500));
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.rbegin(), order.rend(), 0U);
    expectRoundTrip(points, order);
    std::shuffle(order.begin(), order.end(), std::mt19937_64(33));
    expectRoundTrip(points, order);
  }
}

TEST(OrderCoder, ManyEqualPointsTakeNoLongerThanOthers) {
  // Their cells hold all of them: whatever walks through a cell at each step would take hours.
  std::vector<GridPoint> points(300000, GridPoint{5, 5, 5});
  points.push_back({0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF});
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.rbegin(), order.rend(), 0U);
  expectRoundTrip(points, order);
}

TEST(OrderCoder, WhatIsNoPermutationIsRefused) {
  const std::vector<GridPoint> points = test::scannedSphere(34, 3, 4000);
  EXPECT_THROW(encodeOrder(points, std::vector<std::uint32_t>{0, 1, 1}), Error);
  EXPECT_THROW(encodeOrder(points, std::vector<std::uint32_t>{0, 1, 3}), Error);
  EXPECT_THROW(encodeOrder(points, std::vector<std::uint32_t>{0, 1}), Error);
}

TEST(OrderCoder, MemoryStaysWithinTheLimit) {
  std::vector<GridPoint> points;
  std::vector<std::uint32_t> order;
  scanLines(30, points, order);
  EXPECT_THROW(decodeOrder(points, encodeOrder(points, order), 1000), Error);
}

TEST(UnusedSet, RanksAndNumbersAgreeWithASortedList) {
  std::mt19937_64 random(35);
  for (const std::size_t count : {1U, 63U, 64U, 65U, 1000U}) {
    UnusedSet set(count);
    std::vector<std::size_t> left(count);
    std::iota(left.begin(), left.end(), std::size_t{0});
    while (!left.empty()) {
      ASSERT_EQ(set.size(), left.size());
      const std::size_t rank = random() % left.size();
      ASSERT_EQ(set.select(rank), left[rank]);
      ASSERT_EQ(set.rank(left[rank]), rank);
      set.take(left[rank]);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(rank));
    }
  }
}

}  // namespace
}  // namespace bspc::attributes
