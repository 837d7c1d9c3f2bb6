#include "grid/grid_test_support.h"

namespace bspc::test {
namespace {

Grid affine(double origin, double step) {
  Grid grid;
  grid.form = Grid::Form::Affine;
  grid.scalarType = ScalarType::Float64;
  for (Grid::Axis& axis : grid.axes) {
    axis.base = 77;  // which is to count for nothing
    axis.origin = origin;
    axis.step = step;
  }
  return grid;
}

GridRequest knowing(const Grid& grid) {
  GridRequest request;
  request.knownLattice = grid;
  return request;
}

std::vector<double> scaled(double origin, double step, std::int64_t every = 1) {
  return randomOn<double>(3000, -1000000, 1000000,
                          [=](double k) { return k * static_cast<double>(every) * step + origin; });
}

TEST(KnownLattice, ScaleAndOffsetWithoutRoundNumbersAreExact) {
  for (const double origin : {0.0, 500123.4567891, -4000321.789123456, 12.512345678}) {
    for (const double step : {0.001, 1.234567e-5, 0.0003048006096012192, 7.0, 1e-9}) {
      const GridFit fit = fitted(scaled(origin, step), knowing(affine(origin, step)));
      EXPECT_TRUE(fit.exact) << origin << ' ' << step;
      EXPECT_LE(largestIndex(fit), 2000000U) << origin << ' ' << step;
      expectBasesAtMinimum(fit);
    }
  }
}

TEST(KnownLattice, TheWholeRangeOfIndicesFits) {
  std::vector<double> xyz = scaled(1000, 0.001);
  for (const double end : {-2147483648.0, 2147483647.0}) {
    for (std::size_t k = 0; k < 3; ++k) xyz[(end < 0 ? 0 : 3) + k] = end * 0.001 + 1000;
  }
  const GridFit fit = fitted(xyz, knowing(affine(1000, 0.001)));
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(largestIndex(fit), 4294967295U);
}

TEST(KnownLattice, ACoarserOneThatTheSearchFindsIsPreferred) {
  const std::vector<double> whole = randomOn<double>(3000, 0, 1000, [](double k) { return k * 5; });
  const GridFit fit = fitted(whole, knowing(affine(0, 0.001)));
  expectRatio(fit, 5, 1);
}

TEST(KnownLattice, MultiplesThatNoCoordinateUsesAreLeftOut) {
  const GridFit fit = fitted(scaled(0.3, 0x1p-10, 8), knowing(affine(0.3, 0x1p-10)));
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(fit.grid.step(0), 0x1p-7);
}

TEST(KnownLattice, OneThatDoesNotRestoreTheCoordinatesIsNotTaken) {
  const std::vector<double> xyz = scaled(500000, 0.01);
  for (const Grid& wrong : {affine(500000, 0.02), affine(0.123456789, 0.01), affine(0, 1e-300)}) {
    const GridFit fit = fitted(xyz, knowing(wrong));
    const GridFit without = fitted(xyz);
    EXPECT_TRUE(fit.grid.sameLattice(without.grid));
  }
}

TEST(KnownLattice, OneThatIsNoGridIsRefused) {
  messageOf(ErrorCode::InvalidArgument, [] {
    fitted(std::vector<double>{1, 2, 3}, knowing(affine(0, -1)));
  });
}

}  // namespace
}  // namespace bspc::test
