#include "grid/axis_kernel.h"

#include "grid/grid_test_support.h"

namespace bspc::lattice {
namespace {

using Doubles = std::vector<double>;

/// Axes of every form, whose steps go by turns, with narrow and wide multiples.
std::vector<Grid> grids() {
  std::vector<Grid> all;
  const std::int64_t ratios[][3][2] = {{{1, 1000}, {1, 7}, {1, 100}},
                                       {{3, 7}, {1, 8}, {5, 1}},
                                       {{std::int64_t{1} << 62, 1}, {1, 1}, {1, 1}}};
  for (const ScalarType type : {ScalarType::Float32, ScalarType::Float64, ScalarType::Int16}) {
    for (const std::int64_t base : {std::int64_t{0}, std::int64_t{-70000}, std::int64_t{1} << 40}) {
      for (const auto& steps : ratios) {
        Grid grid;
        grid.scalarType = type;
        for (std::size_t k = 0; k < 3; ++k) {
          grid.axes[k] = Grid::Axis{};
          grid.axes[k].base = base;
          grid.axes[k].numerator = steps[k][0];
          grid.axes[k].denominator = steps[k][1];
        }
        all.push_back(grid);
      }
      for (const double step : {0.37, 1e-320, 1e35, 1e299}) {
        Grid grid;
        grid.form = Grid::Form::Affine;
        grid.scalarType = type;
        for (std::size_t k = 0; k < 3; ++k) {
          grid.axes[k].base = base;
          grid.axes[k].origin = -123.456 * static_cast<double>(k);
          grid.axes[k].step = step * static_cast<double>(k + 1);
        }
        all.push_back(grid);
      }
    }
  }
  return all;
}

TEST(AxisKernel, FindsTheMultiplesThatTheMapFinds) {
  std::mt19937_64 random(5);
  unsigned narrow = 0;
  for (const Grid& grid : grids()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisMap map(grid, axis);
      Doubles values;
      for (unsigned i = 0; i < 61; ++i) {
        const auto halves = static_cast<double>(static_cast<std::int32_t>(random())) / 2;
        values.push_back(map.restored(i % 3 == 0 ? halves : std::round(halves)));
      }
      std::array<std::int32_t, 64> multiples{};
      withKernel(map, [&](const auto& kernel) {
        for (const double value : values) EXPECT_EQ(kernel.quotient(value), map.quotient(value));
        if (!nearestMultiples(kernel, values.data(), values.size(), multiples)) return false;
        ++narrow;
        for (std::size_t i = 0; i < values.size(); ++i) {
          EXPECT_EQ(multiples[i], nearestInteger(map.quotient(values[i])));
          EXPECT_EQ(kernel.restored(multiples[i]), map.restored(multiples[i]));
        }
        return true;
      });
    }
  }
  EXPECT_GT(narrow, 60U);
}

TEST(AxisKernel, LeavesMultiplesBeyond32BitsAndNumbersThatAreNoneToTheMap) {
  Grid grid;
  grid.scalarType = ScalarType::Float64;
  const AxisMap map(grid, 0);
  for (const double value : {2147483647.0, -2147483647.0, 1e300, std::nan("")}) {
    std::array<std::int32_t, 4> multiples{};
    const Doubles values{1, value, 2};
    EXPECT_FALSE(withKernel(map, [&](const auto& kernel) {
      return nearestMultiples(kernel, values.data(), values.size(), multiples);
    })) << value;
  }
  grid.scalarType = ScalarType::Int32;
  EXPECT_FALSE(withKernel(AxisMap(grid, 0), [](const auto& /*kernel*/) { return true; }));
}

template <class T>
void expectRestoredAsOneByOne(const Grid& grid, const std::vector<GridPoint>& points) {
  std::vector<T> xyz(3 * points.size());
  restorePositions(grid, Span<const GridPoint>(points), xyz.data());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const double value = restoredCoordinate(grid, static_cast<int>(i % 3), points[i / 3][i % 3]);
    T expected{};
    if constexpr (std::is_same_v<T, double>) {
      expected = value;
    } else {
      expected = nearestFloat(value) + 0.0F;
    }
    ASSERT_EQ(xyz[i], expected);
    ASSERT_EQ(std::signbit(xyz[i]), std::signbit(expected));
  }
}

TEST(AxisKernel, RestoresPointsAsOneByOne) {
  std::mt19937 random(6);
  for (const Grid& grid : grids()) {
    for (const unsigned bits : {12U, 30U, 32U}) {
      std::vector<GridPoint> points(1024 + 37);  // whole blocks and a rest
      for (GridPoint& p : points) {
        for (std::uint32_t& index : p) index = static_cast<std::uint32_t>(random()) >> (32 - bits);
      }
      expectRestoredAsOneByOne<float>(grid, points);
      expectRestoredAsOneByOne<double>(grid, points);
    }
  }
}

}  // namespace
}  // namespace bspc::lattice
