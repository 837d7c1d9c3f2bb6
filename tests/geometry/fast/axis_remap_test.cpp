#include "geometry/fast/axis_remap.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "bspc/error.h"

namespace bspc::geometry::fast {
namespace {

OutputBudget budgetOf(std::uint64_t bytes) {
  TileToDecode tile;
  tile.points = tile.maxPoints = 1U << 30;
  tile.maxBytes = bytes;
  return OutputBudget(tile);
}

/// A lattice of `step` (in 1/1000), rounded to integers.
std::vector<std::uint32_t> lattice(std::size_t count, std::uint64_t step) {
  std::vector<std::uint32_t> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<std::uint32_t>(i * step / 1000));
  }
  return values;
}

/// Points whose y is that of `coordinates`, with a corner at y = 7.
std::vector<GridPoint> pointsAlongY(const std::vector<std::uint32_t>& coordinates) {
  std::vector<GridPoint> points;
  points.reserve(coordinates.size());
  for (const std::uint32_t c : coordinates) points.push_back({1, c + 7, 2});
  return points;
}

/// What is found worth ranking; checks the ranks against it.
std::vector<std::uint32_t> valuesOf(const std::vector<std::uint32_t>& coordinates,
                                    std::uint32_t extent) {
  const std::vector<GridPoint> points = pointsAlongY(coordinates);
  const AxisColumn column(points, 1, 7);
  std::vector<std::uint32_t> values = valuesWorthRanking(column, extent);
  const AxisRanks ranks(column, values);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const std::uint32_t rank = ranks.rank(coordinates[i], i);
    EXPECT_EQ(values.empty() ? rank : values[rank], coordinates[i]);
  }
  return values;
}

GridPoint extentOf(const AxisValues& axes) {
  GridPoint extent{7, 7, 7};
  for (unsigned k = 0; k < 3; ++k) {
    if (!axes[k].empty()) extent[k] = axes[k].back();
  }
  return extent;
}

TEST(AxisRemap, ValuesOfEveryAxisSurvive) {
  std::mt19937_64 random(2);
  std::vector<std::uint32_t> wild{0};
  while (wild.size() < 300) {
    wild.push_back(wild.back() + 1 +
                   static_cast<std::uint32_t>(random() % (1U << (random() % 24))));
  }
  const std::vector<std::uint32_t> none;
  const AxisValues sets[] = {AxisValues{lattice(5000, 3281), none, lattice(100, 50000)},
                             AxisValues{none, wild, none},
                             AxisValues{std::vector<std::uint32_t>{0, 0xFFFFFFFF}, none, none}};
  for (const AxisValues& axes : sets) {
    const Bytes bytes = writeValues(axes);
    const std::array<bool, 3> ranked{!axes[0].empty(), !axes[1].empty(), !axes[2].empty()};
    EXPECT_EQ(readValues(bytes, ranked, 5000, extentOf(axes), budgetOf(1 << 20)), axes);
  }
}

TEST(AxisRemap, AnIrrationalLatticeCostsLittle) {
  EXPECT_LT(writeValues({lattice(10000, 3281), {}, {}}).size(), 10000 / 8);
}

TEST(AxisRemap, RanksAreFoundWhereTheyPay) {
  std::mt19937_64 random(5);
  std::vector<std::uint32_t> coarse{0, 5000};
  std::vector<std::uint32_t> wide{0, 4000000000U};
  std::vector<std::uint32_t> all{0, 4095};
  for (unsigned i = 0; i < 4000; ++i) {
    coarse.push_back(static_cast<std::uint32_t>(random() % 501) * 10);
    wide.push_back(static_cast<std::uint32_t>(random() % 401) * 10000000U);
    all.push_back(static_cast<std::uint32_t>(random() % 4096));
  }
  std::vector<std::uint32_t> middling{0, 200000};
  for (unsigned i = 0; i < 4000; ++i) {
    middling.push_back(static_cast<std::uint32_t>(random() % 101) * 2000);
  }
  std::vector<std::uint32_t> dense = coarse;
  dense.insert(dense.end(), coarse.begin(), coarse.end());
  for (const auto& [coordinates, extent, distinct] :
       {std::tuple{coarse, 5000U, 501U}, std::tuple{dense, 5000U, 501U},
        std::tuple{middling, 200000U, 101U}, std::tuple{wide, 4000000000U, 401U}}) {
    const std::vector<std::uint32_t> values = valuesOf(coordinates, extent);
    EXPECT_EQ(values.size(), distinct);
    EXPECT_TRUE(isRegular(values) || extent > 5000);
  }
  EXPECT_TRUE(valuesOf(all, 4095).empty());
  EXPECT_TRUE(valuesOf({0, 9}, 9).empty());
}

TEST(AxisRemap, RefusesClaimsThatCannotBe) {
  const AxisValues axes{lattice(1000, 3281), {}, {}};
  const Bytes bytes = writeValues(axes);
  const GridPoint extent = extentOf(axes);
  const std::array<bool, 3> ranked{true, false, false};
  EXPECT_THROW(readValues(bytes, ranked, 999, extent, budgetOf(1 << 20)), Error);
  EXPECT_THROW(readValues(bytes, ranked, 1000, extent, budgetOf(1000)), Error);
  EXPECT_THROW(readValues(bytes, ranked, 1000, {extent[0] - 1, 7, 7}, budgetOf(1 << 20)), Error);
  EXPECT_THROW(readValues(bytes, ranked, 1000, {extent[0] + 1, 7, 7}, budgetOf(1 << 20)), Error);
  std::mt19937_64 random(6);
  unsigned refused = 0;
  for (unsigned trial = 0; trial < 3000; ++trial) {
    Bytes damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    if (trial % 4 == 0) damaged.resize(random() % damaged.size());
    try {
      const AxisValues read = readValues(damaged, ranked, 1000, extent, budgetOf(1 << 20));
      ASSERT_EQ(read[0].back(), extent[0]);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 2900U);
}

}  // namespace
}  // namespace bspc::geometry::fast
