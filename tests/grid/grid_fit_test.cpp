#include <cfloat>
#include <limits>

#include "grid/grid_test_support.h"

namespace bspc::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(FitAutomatic, RandomFloatsKeepHalfTheSpacingOfTheLargest) {
  for (const double size : {1e-42, 1e-30, 1e-3, 1.0, 1000.0, 1e30, 3e38}) {
    const auto xyz = randomReals<float>(5000, -size, size / 3);
    double largest = 0;
    for (const float x : xyz) largest = std::max(largest, std::fabs(double{x}));
    const GridFit fit = fitted(xyz);
    const auto single = static_cast<float>(largest);
    const double spacing = double{single} - double{std::nextafter(single, 0.0F)};
    for (const double error : fit.maxError) EXPECT_LE(error, spacing / 2) << size;
    expectBasesAtMinimum(fit);
  }
}

TEST(FitAutomatic, RandomDoublesKeep31BitsOfTheExtent) {
  for (const double size : {1e-310, 1e-300, 1e-3, 1.0, 1e7, 1e300, 1.7e308}) {
    const auto xyz = randomReals<double>(5000, -size / 2, size / 2);
    const GridFit fit = fitted(xyz);
    for (const double error : fit.maxError) EXPECT_LE(error, size * std::ldexp(1, -31)) << size;
    expectBasesAtMinimum(fit);
  }
}

TEST(FitAutomatic, DoublesAtALargeOffsetAreExactAtTheirSpacing) {
  const GridFit fit = fitted(randomReals<double>(3000, 1e15, 1e15 + 1000));
  EXPECT_TRUE(fit.exact);
}

TEST(FitAutomatic, WholeRangeOfDoubles) {
  const GridFit fit = fitted(std::vector<double>{DBL_MAX, -DBL_MAX, 0.1, -DBL_MAX, DBL_MAX / 3,
                                                 5e-324, 1.23e300, 1.1e-310, -7.77e307});
  EXPECT_LE(fit.maxError[0], DBL_MAX * std::ldexp(1, -28));
  EXPECT_TRUE(fitted(std::vector<double>{0x1p1023, 0, 1, -0x1p1023, 1, 2}).exact);
  fitted(std::vector<float>{FLT_MAX, -FLT_MAX, 0.1F, -FLT_MAX, 1e-45F, 0.2F});
}

TEST(FitAutomatic, SinglePointsAreExact) {
  for (const double x : {0.0, -0.0, 1.5, 1e300, -1e-310, 5e-324, 0.1, DBL_MAX}) {
    for (const double y : {3.0, 1.0 / 3, -1e-310, 1e300}) {
      const std::vector<double> once{x, y, 7027188.12};
      EXPECT_TRUE(fitted(once).exact) << x << ' ' << y;
      std::vector<double> thrice = once;
      thrice.insert(thrice.end(), once.begin(), once.end());
      thrice.insert(thrice.end(), once.begin(), once.end());
      for (const GridRequest& request : {GridRequest::automatic(), GridRequest::withBits(12)}) {
        const GridFit fit = fitted(thrice, request);
        EXPECT_TRUE(fit.exact);
        EXPECT_EQ(largestIndex(fit), 0U);
      }
    }
  }
  EXPECT_TRUE(fitted(std::vector<float>{1e-45F, 3.4e38F, 0.1F}).exact);
}

TEST(FitAutomatic, AHighFlatSetKeepsItsOtherAxesFine) {
  std::vector<float> xyz = randomReals<float>(5000, 0, 1);
  for (std::size_t i = 2; i < xyz.size(); i += 3) xyz[i] = 1e6F;
  EXPECT_LE(fitted(xyz).maxError[0], 1e-7);
  for (std::size_t i = 2; i < xyz.size(); i += 3) xyz[i] = 1e-40F;
  EXPECT_EQ(fitted(xyz).maxError[2], 0);
}

TEST(FitAutomatic, EmptySets) {
  for (const GridRequest& request :
       {GridRequest::automatic(), GridRequest::withBits(8), GridRequest::withPrecision(0.5)}) {
    const GridFit fit = fitGrid(PointSetView(nullptr, ScalarType::Float64, 0, 0), request);
    EXPECT_TRUE(fit.points.empty());
    EXPECT_TRUE(fit.exact);
    EXPECT_EQ(fit.grid.scalarType, ScalarType::Float64);
    expectRatio(fit, 1, 1);
  }
}

class FitBits : public ::testing::TestWithParam<unsigned> {};

TEST_P(FitBits, SpansTheLargestExtent) {
  const unsigned bits = GetParam();
  for (const double offset : {0.0, -0.3, 1e6, 123456789.123}) {
    const auto xyz = randomReals<double>(3000, offset, offset + 17, bits);
    const GridFit fit = fitted(xyz, GridRequest::withBits(bits));
    EXPECT_EQ(largestIndex(fit), (std::uint64_t{1} << bits) - 1);
    expectBasesAtMinimum(fit);
    // The double sum rounds where 32 bits come near the spacing of the coordinates.
    const double rounding = std::fabs(offset) * DBL_EPSILON;
    for (const double error : fit.maxError) {
      EXPECT_LE(error, fit.grid.step(0) / 2 * (1 + 1e-6) + rounding);
    }
    if (bits <= 20 && fit.grid.form == Grid::Form::Affine) {
      EXPECT_EQ(fit.grid.step(0), double{static_cast<float>(fit.grid.step(0))});
    }
  }
  const auto floats = randomReals<float>(3000, -1, 1, bits);
  EXPECT_EQ(largestIndex(fitted(floats, GridRequest::withBits(bits))),
            (std::uint64_t{1} << bits) - 1);
}
INSTANTIATE_TEST_SUITE_P(All, FitBits, ::testing::Range(1U, 33U));

TEST(FitBitsOn, WholeStepsAreRational) {
  std::vector<float> xyz = randomOn<float>(500, 0, 4095, [](double k) { return k; });
  xyz[0] = 0;
  xyz[3] = 4095;
  const GridFit fit = fitted(xyz, GridRequest::withBits(12));
  expectRatio(fit, 1, 1);
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(restore<float>(fit), xyz);
}

TEST(FitBitsOn, IntegersNeedNoFinerStepThanOne) {
  const auto xyz = randomOn<std::int32_t>(500, -50, 50, [](double k) { return k; });
  expectRatio(fitted(xyz, GridRequest::withBits(16)), 1, 1);
  const auto wide =
      randomOn<std::int32_t>(500, -2000000000, 2000000000, [](double k) { return k; });
  EXPECT_LE(largestIndex(fitted(wide, GridRequest::withBits(10))), 1023U);
}

TEST(FitBitsOn, DenormalsAndGiants) {
  for (const double size : {1e-323, 1e-320, 1e-310, 1e-300, 1e300, 8e307}) {
    for (const unsigned bits : {1U, 12U, 21U, 32U}) {
      const auto xyz = randomReals<double>(300, -size, size);
      EXPECT_LE(largestIndex(fitted(xyz, GridRequest::withBits(bits))),
                (std::uint64_t{1} << bits) - 1);
    }
  }
  messageOf(ErrorCode::OutOfGrid, [] {
    fitGrid(viewOf(std::vector<double>{-1e308, 0, 0, 1e308, 0, 0}), GridRequest::withBits(12));
  });
}

TEST(FitPrecision, ErrorsAreAtMostHalf) {
  for (const double precision : {1e-6, 0.001, 0.025, 1.0 / 3, 0.1, 1.0, 5.0, 2.5, 1234.5}) {
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const auto xyz = randomReals<double>(2000, -1000, 2000, seed);
      const GridFit fit = fitted(xyz, GridRequest::withPrecision(precision));
      for (const double error : fit.maxError) EXPECT_LE(error, precision / 2 * (1 + 1e-9) + 1e-12);
      const auto floats = randomReals<float>(2000, -1000, 2000, seed);
      const GridFit floatFit = fitted(floats, GridRequest::withPrecision(precision));
      for (const double error : floatFit.maxError) {
        EXPECT_LE(error, precision / 2 * (1 + 1e-9) + 1e-12);
      }
      const auto ints = randomOn<std::int32_t>(
          2000, -1000, 2000, [](double k) { return k; }, seed);
      const GridFit intFit = fitted(ints, GridRequest::withPrecision(precision));
      for (const double error : intFit.maxError) {
        EXPECT_LE(error, precision / 2 * (1 + 1e-9) + 1e-12);
      }
    }
  }
}

TEST(FitPrecision, StepsAreShortDecimals) {
  const auto xyz = randomReals<double>(100, 0, 100);
  expectRatio(fitted(xyz, GridRequest::withPrecision(0.001)), 1, 1000);
  expectRatio(fitted(xyz, GridRequest::withPrecision(0.025)), 1, 40);
  expectRatio(fitted(xyz, GridRequest::withPrecision(5)), 5, 1);
  expectRatio(fitted(xyz, GridRequest::withPrecision(1.5)), 3, 2);
  expectRatio(fitted(xyz, GridRequest::withPrecision(1e16)), 10000000000000000, 1);
}

TEST(FitPrecision, FloatsTooCoarseForTheBoundBecomeDoubles) {
  const auto xyz = randomReals<float>(50000, 1000, 2000);
  EXPECT_EQ(fitted(xyz, GridRequest::withPrecision(0.1)).grid.scalarType, ScalarType::Float64);
  const auto whole = randomOn<float>(2000, 1000, 2000, [](double k) { return k; });
  EXPECT_EQ(fitted(whole, GridRequest::withPrecision(2)).grid.scalarType, ScalarType::Float32);
}

TEST(FitPrecision, IntegersKeepTheirTypeWhereTheBoundHolds) {
  const auto xyz = randomOn<std::int32_t>(500, -50, 50, [](double k) { return k; });
  EXPECT_EQ(fitted(xyz, GridRequest::withPrecision(0.5)).grid.scalarType, ScalarType::Int32);
  EXPECT_EQ(fitted(xyz, GridRequest::withPrecision(2)).grid.scalarType, ScalarType::Int32);
  EXPECT_EQ(fitted(xyz, GridRequest::withPrecision(1.5)).grid.scalarType, ScalarType::Float64);
}

TEST(FitPrecision, TellsTheAxisAndAWorkablePrecision) {
  const std::vector<double> xyz{0, 0, 0, 1, 6000, 1};
  const std::string message = messageOf(
      ErrorCode::OutOfGrid, [&] { fitGrid(viewOf(xyz), GridRequest::withPrecision(1e-6)); });
  EXPECT_NE(message.find("along y"), std::string::npos) << message;
  EXPECT_NE(message.find("1.4e-06"), std::string::npos) << message;
  fitted(xyz, GridRequest::withPrecision(1.4e-6));
  messageOf(ErrorCode::OutOfGrid, [] {
    fitGrid(viewOf(std::vector<double>{-1e308, 0, 0, 1e308, 0, 0}), GridRequest::withPrecision(1));
  });
}

TEST(FitPrecision, FarAndTinyCoordinates) {
  EXPECT_TRUE(fitted(std::vector<double>{1e300, 1, 2}, GridRequest::withPrecision(0.001)).exact);
  const GridFit tiny =
      fitted(randomReals<double>(100, 0, 1e-305), GridRequest::withPrecision(1e-310));
  EXPECT_EQ(tiny.grid.form, Grid::Form::Affine);
  EXPECT_LE(tiny.maxError[0], 0.51e-310);
}

TEST(FitReuse, KeepsTheLatticeAndMovesTheBase) {
  for (const GridRequest& request : {GridRequest::withPrecision(0.01), GridRequest::withBits(14)}) {
    const Grid grid = fitted(randomReals<double>(500, 10, 20), request).grid;
    const auto others = randomReals<double>(500, -5, 7, 9);
    const GridFit fit = fitted(others, GridRequest::onGrid(grid));
    EXPECT_TRUE(fit.grid.sameLattice(grid));
    EXPECT_LE(fit.maxError[0], grid.step(0) / 2 * (1 + 1e-9));
    expectBasesAtMinimum(fit);
    const std::vector<double> back = restore<double>(fit);
    EXPECT_TRUE(fitted(back, GridRequest::onGrid(grid)).exact);
  }
}

TEST(FitReuse, RefusesWhatDoesNotFit) {
  const Grid grid = fitted(std::vector<double>{0.001, 0, 0, 1, 1, 1}).grid;
  EXPECT_NE(messageOf(ErrorCode::OutOfGrid,
                      [&] {
                        fitGrid(viewOf(std::vector<double>{0, 0, 1e15}), GridRequest::onGrid(grid));
                      })
                .find("z = 1e+15"),
            std::string::npos);
  messageOf(ErrorCode::OutOfGrid, [&] {
    fitGrid(viewOf(std::vector<double>{0, 0, 0, 0, 1e9, 0}), GridRequest::onGrid(grid));
  });
}

TEST(FitNonFinite, NamesTheFirstPoint) {
  std::vector<float> xyz = randomOn<float>(2000, 0, 9, [](double k) { return k; });
  xyz[3 * 1234 + 1] = std::numeric_limits<float>::quiet_NaN();
  xyz[std::size_t{3} * 1999] = -std::numeric_limits<float>::infinity();
  const std::string message = messageOf(ErrorCode::NonFinite, [&] { fitGrid(viewOf(xyz), {}); });
  for (const char* part : {"point 1234", "y = nan", "and 1 more", "--drop-nonfinite"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(FitNonFinite, DropsOnWish) {
  std::vector<double> xyz = randomOn<double>(2000, 0, 9, [](double k) { return k; });
  xyz[0] = kInf;
  xyz[3 * 1000 + 2] = std::numeric_limits<double>::quiet_NaN();
  xyz[3 * 1000 + 1] = -kInf;
  GridRequest request;
  request.dropNonFinite = true;
  const GridFit fit = fitted(xyz, request);
  EXPECT_EQ(fit.dropped, 2U);
  EXPECT_EQ(fit.points.size(), 1998U);
  EXPECT_EQ(fit.sourceIndex.front(), 1U);
  EXPECT_EQ(fit.sourceIndex[999], 1001U);
  EXPECT_TRUE(fit.exact);
  const GridFit none = fitted(std::vector<double>{kInf, 0, 0, 0, kInf, 1}, request);
  EXPECT_EQ(none.dropped, 2U);
  EXPECT_TRUE(none.points.empty());
  EXPECT_TRUE(fitted(std::vector<double>{1, 2, 3}, request).sourceIndex.empty());
}

TEST(FitProgress, RisesToOneAndCancels) {
  const auto xyz = randomReals<float>(200000, 0, 1);
  double last = 0;
  fitGrid(viewOf(xyz), GridRequest::withPrecision(1e-6), [&last](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1);
  messageOf(ErrorCode::Cancelled,
            [&] { fitGrid(viewOf(xyz), {}, [](double share) { return share < 0.6; }); });
}

}  // namespace
}  // namespace bspc::test
