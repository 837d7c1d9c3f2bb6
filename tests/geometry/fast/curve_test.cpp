#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "geometry/fast/slab_curve.h"
#include "geometry/fast/tile_sequence.h"

namespace bspc::geometry::fast {
namespace {

TEST(HilbertPlane, VisitsEveryPositionAndOnlyStepsToNeighbours) {
  const HilbertPlane& curve = HilbertPlane::instance();
  for (const unsigned levels : {4U, 8U}) {
    const std::uint32_t cells = 1U << (2 * levels);
    std::uint32_t before = curve.position(0, levels);
    for (std::uint32_t place = 0; place < cells; ++place) {
      const std::uint32_t xy = curve.position(place, levels);
      ASSERT_EQ(curve.place(xy >> 16, xy & 0xFFFF, levels), place);
      if (place > 0) {
        const int dx = static_cast<int>(xy >> 16) - static_cast<int>(before >> 16);
        const int dy = static_cast<int>(xy & 0xFFFF) - static_cast<int>(before & 0xFFFF);
        ASSERT_EQ(std::abs(dx) + std::abs(dy), 1);
      }
      before = xy;
    }
  }
}

TEST(HilbertSpace, VisitsEveryPositionAndOnlyStepsToNeighbours) {
  constexpr unsigned kBits = 4;
  std::vector<GridPoint> points;
  for (std::uint32_t i = 0; i < (1U << (3 * kBits)); ++i) {
    points.push_back({i & 15, (i >> 4) & 15, i >> 8});
  }
  std::set<std::uint64_t> places;
  for (const GridPoint& p : points) places.insert(hilbertPlaceInSpace(p, kBits));
  EXPECT_EQ(places.size(), points.size());
  EXPECT_EQ(*places.rbegin(), points.size() - 1);
  const std::vector<std::uint32_t> sequence = hilbertSequence(points, {15, 15, 15});
  for (std::size_t i = 1; i < sequence.size(); ++i) {
    const GridPoint& a = points[sequence[i - 1]];
    const GridPoint& b = points[sequence[i]];
    int steps = 0;
    for (unsigned k = 0; k < 3; ++k) {
      steps += std::abs(static_cast<int>(a[k]) - static_cast<int>(b[k]));
    }
    ASSERT_EQ(steps, 1);
  }
}

TEST(HilbertSpace, PointsOfOnePlaceComeInOrderOfTheirCoordinates) {
  const GridPoint extent{0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF};
  const std::vector<GridPoint> points{{9, 9, 9}, {0, 0, 2}, {0, 0, 1}, {extent}, {0, 0, 1}};
  const std::vector<std::uint32_t> sequence = hilbertSequence(points, extent);
  EXPECT_EQ(points[sequence[0]], (GridPoint{0, 0, 1}));
  EXPECT_EQ(points[sequence[2]], (GridPoint{0, 0, 2}));
  EXPECT_EQ(points[sequence[3]], (GridPoint{9, 9, 9}));
}

TEST(SlabFrame, CodesAndPositionsAreInverse) {
  std::mt19937_64 random(3);
  for (unsigned trial = 0; trial < 2000; ++trial) {
    Cell cell;
    StepScale scale;
    for (unsigned k = 0; k < 3; ++k) {
      cell.levels[k] = static_cast<std::uint8_t>(random() % 33);
      scale[k] = static_cast<std::uint8_t>(trial % 2 == 0 ? 0 : random() % 32);
    }
    const SlabFrame frame(cell, scale, trial % 3, trial % 5 == 0 ? 100000 : 1000);
    ASSERT_LE(frame.codeBits(), kMaxFieldBits);
    std::uint32_t u[2];
    for (unsigned k = 0; k < 2; ++k) {
      ASSERT_LE(frame.levels[k] - frame.below[k], frame.curveLevels);
      u[k] = static_cast<std::uint32_t>(random() & lowBits(frame.levels[k]));
    }
    const std::uint64_t code = codeOf(HilbertPlane::instance(), frame, u[0], u[1]);
    ASSERT_EQ(code >> frame.codeBits(), 0U);
    std::uint32_t back[2];
    positionsOfCodes(frame, &code, 1, &back[0], &back[1]);
    ASSERT_EQ(back[0], u[0]);
    ASSERT_EQ(back[1], u[1]);
  }
}

TEST(Cell, SplitsItsLongestAxis) {
  Cell cell = rootCell({1023, 1024, 3});
  EXPECT_EQ(cell.levels[0], 10);
  EXPECT_EQ(cell.levels[1], 11);
  EXPECT_EQ(cell.splitAxis({0, 0, 0}), 1U);
  EXPECT_EQ(cell.splitAxis({1, 0, 0}), 0U);
  EXPECT_EQ(cell.splitAxis({0, 0, 10}), 2U);
  EXPECT_EQ(cell.upperHalf(1).lower[1], 1024U);
  EXPECT_TRUE(rootCell({0, 0, 0}).isUnit());
}

TEST(LayerStrides, EveryPointIsNewInExactlyOneLayer) {
  for (const std::uint64_t points : {1U, 2U, 63U, 64U, 65U, 5000U}) {
    for (const unsigned layers : {1U, 2U, 3U, 32U}) {
      const LayerStrides strides(points, layers, 3);
      std::uint64_t all = 0;
      for (unsigned l = 0; l < layers; ++l) {
        std::uint64_t news = 0;
        for (std::uint64_t place = 0; place < points; ++place) news += strides.isNew(place, l);
        EXPECT_EQ(news, strides.inLayer(l));
        all += news;
        EXPECT_EQ(strides.upTo(l), all);
        EXPECT_GE(all, 1U);
      }
      EXPECT_EQ(all, points);
    }
  }
}

}  // namespace
}  // namespace bspc::geometry::fast
