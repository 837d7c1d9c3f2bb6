#include "geometry/predictive/phase_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/predictive/periodogram.h"
#include "support/point_sets.h"

namespace bspc::geometry::predictive {
namespace {

constexpr double kUnit = 4294967296.0;

/// Points near multiples of `period` along x, random along the other axes.
std::vector<GridPoint> latticePoints(double period, std::uint32_t cells, std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<GridPoint> points(count);
  for (GridPoint& p : points) {
    const auto cell = static_cast<double>(random() % cells);
    p = {static_cast<std::uint32_t>(std::lround(cell * period)),
         static_cast<std::uint32_t>(random() % 5000), static_cast<std::uint32_t>(random() % 5000)};
  }
  return points;
}

TEST(PhaseFrequency, IsThatOfTheLattice) {
  for (const double period : {3.125, 11.7, 49.3}) {
    const std::vector<GridPoint> points = latticePoints(period, 400, 2000);
    const std::uint32_t f = findPhaseFrequency(points, 0);
    ASSERT_NE(f, 0U) << period;
    // Right to a tenth of a turn from one end to the other.
    EXPECT_NEAR(f / kUnit, 1 / period, 0.1 / (400 * period)) << period;
  }
}

TEST(PhaseFrequency, IsFoundFarFromTheOrigin) {
  std::vector<GridPoint> points = latticePoints(11.7, 4000, 5000);
  for (GridPoint& p : points) p[0] += 3000000;
  EXPECT_NEAR(findPhaseFrequency(points, 0) / kUnit, 1 / 11.7, 1e-6);
}

TEST(PhaseFrequency, NoneWhereThereIsNoLattice) {
  const std::vector<GridPoint> points = latticePoints(11.7, 400, 2000);
  EXPECT_EQ(findPhaseFrequency(points, 1), 0U);
  EXPECT_EQ(findPhaseFrequency(test::scannedSphere(3, 3000, 60000), 2), 0U);
  EXPECT_EQ(findPhaseFrequency(test::randomPoints(4, 500, {100, 4000000000U, 7}), 0), 0U);
  EXPECT_EQ(findPhaseFrequency(test::randomPoints(4, 500, {100, 4000000000U, 7}), 1), 0U);
  EXPECT_EQ(findPhaseFrequency(test::randomPoints(4, 500, {100, 4000000000U, 7}), 2), 0U);
}

TEST(PhaseFrequency, TakesDegenerateSets) {
  EXPECT_EQ(findPhaseFrequency({}, 0), 0U);
  for (const test::NamedPoints& set : test::degenerateSets()) {
    for (unsigned axis = 0; axis < 3; ++axis) findPhaseFrequency(set.points, axis);
  }
}

TEST(PhaseHistogram, TellsWhichHalfOfABoxThePhasesLieIn) {
  PhaseHistogram phases(static_cast<std::uint32_t>(kUnit / 10));
  ASSERT_TRUE(phases.isActive());
  EXPECT_EQ(phases.maxLevel(), 5U);  // 32 steps hold three periods, 16 not two
  for (std::uint32_t i = 0; i < 100; ++i) phases.add(10 * i + 6);
  const PhaseHistogram::Sides upper = phases.sides(1000, 3);  // 1000 … 1007: 1006 in the upper half
  EXPECT_GT(upper.upper, 20 * upper.lower);
  const PhaseHistogram::Sides lower = phases.sides(1005, 3);
  EXPECT_GT(lower.lower, 20 * lower.upper);
  EXPECT_GT(phases.weight(16), phases.weight(15));
  EXPECT_FALSE(PhaseHistogram().isActive());
  EXPECT_EQ(PhaseHistogram().maxLevel(), 0U);
}

TEST(PhaseHistogram, WeightsStayBounded) {
  PhaseHistogram phases(0x40000000);
  for (int i = 0; i < 2000000; ++i) phases.add(0);
  EXPECT_LE(phases.weight(0), 1U << 24);
  EXPECT_GT(phases.weight(0), 1000 * phases.weight(1));
}

TEST(Periodogram, TakesTheLowestOfHarmonics) {
  std::vector<std::uint32_t> values;
  for (std::uint32_t i = 0; i < 100; ++i) values.push_back(500 + 20 * i);
  Periodogram periodogram;
  const auto peak = periodogram.peak(values, 0.01);
  ASSERT_TRUE(peak);
  EXPECT_NEAR(peak->frequency, 0.05, 0.0002);
  EXPECT_GT(peak->coherence, 0.9);
  EXPECT_FALSE(periodogram.peak({}, 0.01));
}

TEST(Periodogram, FindsTheDensestWindow) {
  const std::vector<std::uint32_t> values = {0, 100, 200, 203, 207, 300};
  EXPECT_EQ(densestWindow(values, 3), 2U);
}

}  // namespace
}  // namespace bspc::geometry::predictive
