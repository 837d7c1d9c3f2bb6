#include "grid/points_in_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace bspc::lattice {
namespace {

/// Points of any type, each with some bytes behind it.
template <class T>
class StridedPoints {
 public:
  explicit StridedPoints(const std::vector<T>& xyz, std::size_t gap)
      : stride_(3 * sizeof(T) + gap), count_(xyz.size() / 3), bytes_(count_ * stride_ + 1) {
    for (std::size_t i = 0; i < count_; ++i) {
      // One byte off, so that no number is aligned.
      std::memcpy(&bytes_[1 + i * stride_], &xyz[3 * i], 3 * sizeof(T));
    }
  }
  PointSetView view(ScalarType type) const { return {&bytes_[1], type, count_, stride_}; }

 private:
  std::size_t stride_;
  std::size_t count_;
  std::vector<unsigned char> bytes_;
};

TEST(ExactDivisor, DividesAsDivisionDoes) {
  std::mt19937_64 random(1);
  for (unsigned trial = 0; trial < 3000; ++trial) {
    const std::uint64_t d = 1 + (random() >> (random() % 64)) / 2;
    const ExactDivisor divisor(d);
    const std::uint64_t n = random() >> (random() % 64);
    ASSERT_EQ(divisor.divides(n), n % d == 0) << n << " by " << d;
    const std::uint64_t multiple = n / d * d;
    ASSERT_TRUE(divisor.divides(multiple));
    ASSERT_EQ(divisor.quotient(multiple), multiple / d);
  }
  EXPECT_EQ(ExactDivisor().quotient(77), 77U);
}

template <class T>
void expectRanges(ScalarType type) {
  std::mt19937_64 random(2);
  for (std::size_t count = 1; count < 14; ++count) {
    std::vector<T> xyz(3 * count);
    for (T& v : xyz) v = static_cast<T>(static_cast<int>(random() % 100));
    for (const std::size_t gap : {std::size_t{0}, std::size_t{5}}) {
      const StridedPoints<T> points(xyz, gap);
      const Ranges ranges = rangesInMemory(points.view(type));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        T low = xyz[axis];
        T high = xyz[axis];
        for (std::size_t i = axis; i < xyz.size(); i += 3) {
          low = std::min(low, xyz[i]);
          high = std::max(high, xyz[i]);
        }
        ASSERT_EQ(ranges[axis].min, static_cast<double>(low));
        ASSERT_EQ(ranges[axis].max, static_cast<double>(high));
      }
    }
  }
}

TEST(PointsInMemory, RangesOfEveryTypeAndStride) {
  expectRanges<float>(ScalarType::Float32);
  expectRanges<double>(ScalarType::Float64);
  expectRanges<std::int8_t>(ScalarType::Int8);
  expectRanges<std::uint16_t>(ScalarType::UInt16);
  expectRanges<std::int32_t>(ScalarType::Int32);
  expectRanges<std::uint64_t>(ScalarType::UInt64);
}

TEST(PointsInMemory, MinusZeroCountsAsZero) {
  const std::vector<float> xyz(12, -0.0F);
  EXPECT_FALSE(std::signbit(rangesInMemory(PointSetView(xyz.data(), 4))[1].min));
}

TEST(PointsInMemory, EveryNumberThatIsNotFiniteIsNoticed) {
  for (std::size_t count = 1; count < 10; ++count) {
    for (std::size_t bad = 0; bad < 3 * count; ++bad) {
      std::vector<double> xyz(3 * count, 1e300);
      EXPECT_TRUE(allFinite(PointSetView(xyz.data(), count)));
      xyz[bad] = bad % 2 == 0 ? std::numeric_limits<double>::infinity()
                              : std::numeric_limits<double>::quiet_NaN();
      EXPECT_FALSE(allFinite(PointSetView(xyz.data(), count)));
    }
  }
}

TEST(PointsInMemory, CommonDivisorsOfWholeNumbersOnly) {
  const std::vector<float> xyz{-12, 0, 1, 18, 0, 2.5F, 0, 0, 3};
  const PointSetView points(xyz.data(), 3);
  EXPECT_EQ(wholeDivisor(points, 0), 6U);
  EXPECT_EQ(wholeDivisor(points, 1), 0U);
  EXPECT_EQ(wholeDivisor(points, 2), std::nullopt);
  const std::vector<double> large{9007199254740992.0, 9007199254740991.0, 1e300};
  for (const std::size_t axis : {0U, 2U}) {
    EXPECT_EQ(wholeDivisor(PointSetView(large.data(), 1), axis), std::nullopt);
  }
  EXPECT_EQ(wholeDivisor(PointSetView(large.data(), 1), 1), 9007199254740991U);
}

TEST(PointsInMemory, IndicesCountStepsFromTheLowest) {
  const std::vector<std::int32_t> xyz{-2147483647, 0, 7, 2147483647, 12, 7, -1, 36, 7};
  const std::array<WholeAxis, 3> axes{WholeAxis{-2147483647, ExactDivisor(2)},
                                      WholeAxis{0, ExactDivisor(12)}, WholeAxis{7, ExactDivisor()}};
  std::vector<GridPoint> points(2);
  wholeIndices(PointSetView(xyz.data(), 3), 1, 2, axes, points.data());
  EXPECT_EQ(points[0], (GridPoint{2147483647, 1, 0}));
  EXPECT_EQ(points[1], (GridPoint{1073741823, 3, 0}));
}

template <class T>
void expectRestored(const Grid& grid, const std::vector<GridPoint>& points) {
  std::vector<T> xyz(3 * points.size());
  restorePositions(grid, Span<const GridPoint>(points), xyz.data());
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double expected = restoredCoordinate(grid, 1, points[j][1]);
    if constexpr (std::is_floating_point_v<T>) {
      ASSERT_EQ(xyz[3 * j + 1], static_cast<T>(expected));
    } else {
      constexpr auto kLow = static_cast<double>(std::numeric_limits<T>::min());
      constexpr auto kHigh = static_cast<double>(std::numeric_limits<T>::max());
      ASSERT_EQ(xyz[3 * j + 1], static_cast<T>(std::max(kLow, std::min(kHigh, expected))));
    }
  }
}

TEST(WholeNumbers, AreRestoredAsTheFormulasSay) {
  std::mt19937_64 random(3);
  for (const ScalarType type :
       {ScalarType::Float32, ScalarType::Float64, ScalarType::Int8, ScalarType::UInt16,
        ScalarType::Int32, ScalarType::UInt32, ScalarType::Int64}) {
    for (const std::int64_t base :
         {std::int64_t{0}, std::int64_t{-100}, std::int64_t{16777200}, std::int64_t{2147483600},
          std::int64_t{-2147483648}, std::int64_t{1} << 40}) {
      Grid grid;
      grid.scalarType = type;
      for (Grid::Axis& axis : grid.axes) axis.base = base;
      for (const unsigned bits : {5U, 8U, 25U, 32U}) {
        std::vector<GridPoint> points(7);
        for (GridPoint& p : points) {
          for (std::uint32_t& v : p) v = static_cast<std::uint32_t>(random() >> (64 - bits));
        }
        expectRestored<float>(grid, points);
        expectRestored<double>(grid, points);
        expectRestored<std::int8_t>(grid, points);
        expectRestored<std::uint16_t>(grid, points);
        expectRestored<std::int32_t>(grid, points);
        expectRestored<std::uint32_t>(grid, points);
      }
    }
  }
}

}  // namespace
}  // namespace bspc::lattice
