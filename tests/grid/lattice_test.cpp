#include <cfloat>

#include "grid/grid_test_support.h"

namespace bspc::test {
namespace {

TEST(Lattice, DecimalsInDoubles) {
  const auto xyz = randomOn<double>(5000, 702000000, 702718812, [](double k) { return k / 100; });
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  expectRatio(fit, 1, 100);
  expectBasesAtMinimum(fit);
  EXPECT_EQ(restore<double>(fit), xyz);
}

TEST(Lattice, UtmCoordinateKeepsItsText) {
  const std::vector<double> xyz{7027188.12, 432100.07, 12.34, 7027190.01, 432100.5, 12.01};
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  expectRatio(fit, 1, 100);
  EXPECT_EQ(restore<double>(fit), xyz);
}

TEST(Lattice, DecimalsInFloats) {
  const auto xyz = randomOn<float>(5000, -99999, 99999, [](double k) { return k / 1000; });
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  expectRatio(fit, 1, 1000);
  EXPECT_EQ(restore<float>(fit), xyz);
}

TEST(Lattice, CommonDivisorMakesStepsCoarser) {
  expectRatio(fitted(randomOn<double>(500, -900, 900, [](double k) { return k * 25 / 1000; })), 1,
              40);
  expectRatio(fitted(randomOn<float>(500, -900, 900, [](double k) { return k * 5; })), 5, 1);
  expectRatio(fitted(randomOn<std::int32_t>(500, -900, 900, [](double k) { return k * 6; })), 6, 1);
}

TEST(Lattice, PowersOfTwo) {
  const GridFit fit =
      fitted(randomOn<double>(500, -30000, 30000, [](double k) { return std::ldexp(k, -15); }));
  EXPECT_TRUE(fit.exact);
  expectRatio(fit, 1, 32768);
  const GridFit coarse =
      fitted(randomOn<float>(500, -30000, 30000, [](double k) { return std::ldexp(k, 40); }));
  EXPECT_TRUE(coarse.exact);
  expectRatio(coarse, std::int64_t{1} << 40, 1);
}

TEST(Lattice, PowersOfTwoBeyondRationalSteps) {
  for (const int exponent : {-1060, -900, -100, 100, 900}) {
    const auto xyz = randomOn<double>(500, -30000, 30000,
                                      [exponent](double k) { return std::ldexp(k, exponent); });
    const GridFit fit = fitted(xyz);
    EXPECT_TRUE(fit.exact) << exponent;
    EXPECT_EQ(fit.grid.form, Grid::Form::Affine);
    EXPECT_EQ(fit.grid.step(0), std::ldexp(1, exponent));
    expectBasesAtMinimum(fit);
  }
}

TEST(Lattice, IntegersOfEveryType) {
  const std::vector<std::int8_t> small{-128, 127, 0, 1, 2, 3};
  const GridFit fit = fitGrid(viewOf(small, ScalarType::Int8), {});
  expectHonest(viewOf(small, ScalarType::Int8), fit);
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(restore<std::int8_t>(fit), small);
  const std::vector<std::int32_t> whole{INT32_MIN, 0, 7, INT32_MAX, 1, 9};
  const GridFit wholeFit = fitted(whole);
  EXPECT_TRUE(wholeFit.exact);
  EXPECT_EQ(largestIndex(wholeFit), UINT32_MAX);
  EXPECT_EQ(restore<std::int32_t>(wholeFit), whole);
  const std::vector<std::uint32_t> positive{0, 0, 7, UINT32_MAX, 1, 9};
  const GridFit positiveFit = fitGrid(viewOf(positive, ScalarType::UInt32), {});
  EXPECT_TRUE(positiveFit.exact);
  EXPECT_EQ(restore<std::uint32_t>(positiveFit), positive);
}

TEST(Lattice, LongIntegers) {
  const std::int64_t far = std::int64_t{1} << 52;
  const std::vector<std::int64_t> near{far, -far, 0, far + 5, -far + 7, 3};
  const GridFit fit = fitGrid(viewOf(near, ScalarType::Int64), {});
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(restore<std::int64_t>(fit), near);
  const std::vector<std::int64_t> wide{0, 0, 0, far + 1, 5, 7};
  const std::string message =
      messageOf(ErrorCode::OutOfGrid, [&] { fitGrid(viewOf(wide, ScalarType::Int64), {}); });
  EXPECT_NE(message.find("along x"), std::string::npos) << message;
  // A common divisor brings the same extent back into 32 bits.
  const std::vector<std::int64_t> coarse{0, 0, 0, far, 1 << 21, 1 << 22};
  EXPECT_TRUE(fitGrid(viewOf(coarse, ScalarType::Int64), {}).exact);
  const std::vector<std::int64_t> huge{0, 0, 0, 1, 2 * far + 1, 0};
  EXPECT_NE(
      messageOf(ErrorCode::InvalidArgument, [&] { fitGrid(viewOf(huge, ScalarType::Int64), {}); })
          .find("point 1 has y"),
      std::string::npos);
  const std::vector<std::uint64_t> hugeUnsigned{0, 0, UINT64_MAX};
  messageOf(ErrorCode::InvalidArgument,
            [&] { fitGrid(viewOf(hugeUnsigned, ScalarType::UInt64), {}); });
}

TEST(Lattice, StepsOfTheirOwnWhereOneWouldBeTooFine) {
  std::vector<double> xyz = randomOn<double>(500, 0, 1000000, [](double k) { return k; });
  for (std::size_t i = 2; i < xyz.size(); i += 3) xyz[i] = xyz[i] / 100000;
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(fit.grid.step(0), 1);
  EXPECT_EQ(fit.grid.step(2), 1 / 100000.0);
}

TEST(Lattice, NearStepsAreShared) {
  std::vector<double> xyz = randomOn<double>(500, 0, 1000, [](double k) { return k / 10; });
  for (std::size_t i = 2; i < xyz.size(); i += 3) xyz[i] = std::round(xyz[i] * 100) / 1000;
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  expectRatio(fit, 1, 100);
}

TEST(Lattice, FineAxisDoesNotSufferFromALargeOne) {
  std::vector<float> xyz = randomOn<float>(500, 0, 4000000, [](double k) { return k; });
  for (std::size_t i = 2; i < xyz.size(); i += 3) {
    xyz[i] = static_cast<float>(std::fmod(double{xyz[i]}, 997) / 1000);
  }
  EXPECT_TRUE(fitted(xyz).exact);
}

TEST(Lattice, ConstantAxes) {
  std::vector<double> flat = randomOn<double>(500, 0, 1000, [](double k) { return k / 10; });
  for (std::size_t i = 2; i < flat.size(); i += 3) flat[i] = 0.375;
  const GridFit fit = fitted(flat);
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(fit.grid.step(0), 0.1);
  for (std::size_t i = 2; i < flat.size(); i += 3) flat[i] = 7.5;
  expectRatio(fitted(flat), 1, 10);
  for (const double z : {1.0 / 3, 1e300, 1e-310, -DBL_MAX}) {
    std::vector<double> odd = randomOn<double>(500, 0, 1000, [](double k) { return k / 4; });
    for (std::size_t i = 2; i < odd.size(); i += 3) odd[i] = z;
    EXPECT_TRUE(fitted(odd).exact) << z;
  }
}

TEST(Lattice, NegativeZeroBecomesZero) {
  const std::vector<float> xyz{-0.0F, 1, 2, 3, -0.0F, -0.0F};
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  for (const float x : restore<float>(fit)) EXPECT_FALSE(x == 0 && std::signbit(x));
}

class RequantisedFloats : public ::testing::TestWithParam<unsigned> {};

TEST_P(RequantisedFloats, AreFoundAgain) {
  for (const double offset : {0.0, -7.3, 1234.5}) {
    const auto xyz = randomReals<float>(20000, offset, offset + 10, GetParam());
    const GridFit first = fitted(xyz, GridRequest::withBits(GetParam()));
    EXPECT_EQ(largestIndex(first), (std::uint64_t{1} << GetParam()) - 1);
    const GridFit second = fitted(restore<float>(first));
    EXPECT_TRUE(second.exact) << offset;
    // Steps near the spacing of the floats may be found as that spacing.
    if (offset < 1000) {
      EXPECT_EQ(largestIndex(second), largestIndex(first)) << offset;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Bits, RequantisedFloats,
                         ::testing::Values(4U, 8U, 10U, 12U, 14U, 16U, 18U));

class RequantisedDoubles : public ::testing::TestWithParam<unsigned> {};

TEST_P(RequantisedDoubles, AreFoundAgain) {
  for (const double offset : {0.0, -7.3, 1234.5, 5e6}) {
    const auto xyz = randomReals<double>(20000, offset, offset + 10, GetParam());
    const GridFit first = fitted(xyz, GridRequest::withBits(GetParam()));
    EXPECT_EQ(largestIndex(first), (std::uint64_t{1} << GetParam()) - 1);
    const GridFit second = fitted(restore<double>(first));
    EXPECT_TRUE(second.exact) << offset;
    EXPECT_EQ(largestIndex(second), largestIndex(first)) << offset;
  }
}
INSTANTIATE_TEST_SUITE_P(Bits, RequantisedDoubles,
                         ::testing::Values(6U, 8U, 12U, 16U, 20U, 22U, 24U));

TEST(Lattice, ScaleAndOffsetInDoubles) {
  struct Case {
    double offset;
    std::int64_t low;
    std::int64_t high;
  };
  // Offsets are round, or the whole number below the data.
  for (const auto& [offset, low, high] :
       {Case{0, -3000000, 4000000}, Case{500000, -3000000, 4000000}, Case{4100000, -900000, 900000},
        Case{431234, 5, 4000000}, Case{-23, 5, 4000000}}) {
    for (const double scale : {0.01, 0.001}) {
      auto xyz = randomOn<double>(20000, low, high,
                                  [s = scale, o = offset](double k) { return k * s + o; });
      for (std::size_t axis = 0; axis < 3; ++axis) {
        xyz[axis] = static_cast<double>(low) * scale + offset;
      }
      const GridFit fit = fitted(xyz);
      EXPECT_TRUE(fit.exact) << scale << ' ' << offset;
      EXPECT_NEAR(fit.grid.step(0), scale, scale * 1e-9);
    }
  }
}

TEST(Lattice, FloatsFromAnOriginAndAnOddStep) {
  for (const double step : {0.0123456789, 1.0 / 3, 0.7071067811865475, 3.3e-20}) {
    const auto xyz = randomOn<float>(20000, 0, 5000, [&](double k) { return k * step; });
    const GridFit fit = fitted(xyz);
    EXPECT_TRUE(fit.exact) << step;
    EXPECT_LE(largestIndex(fit), 5000U);
  }
}

TEST(Lattice, AxesWithMultiplesOfOneAffineStep) {
  const float step = 0.0123456F;
  std::vector<float> xyz =
      randomOn<float>(20000, 0, 3000, [&](double k) { return k * double{step}; });
  for (std::size_t i = 1; i < xyz.size(); i += 3) {
    xyz[i] = static_cast<float>(std::round(double{xyz[i]} / double{step}) * 3 * double{step});
  }
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  EXPECT_EQ(fit.grid.step(0), fit.grid.step(1));
  EXPECT_LE(largestIndex(fit), 9000U);
}

TEST(Lattice, AffineStepsOfTheirOwn) {
  std::mt19937_64 random(5);
  const std::array<double, 3> steps{0.0123456F, 0.0777777F, 0.0312347F};
  std::vector<float> xyz;
  for (int i = 0; i < 10000; ++i) {
    for (const double step : steps) {
      xyz.push_back(static_cast<float>(static_cast<double>(random() % 2000) * step));
    }
  }
  const GridFit fit = fitted(xyz);
  EXPECT_TRUE(fit.exact);
  EXPECT_LE(largestIndex(fit), 2000U);
}

TEST(Lattice, NoneInRandomNumbers) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    EXPECT_FALSE(fitted(randomReals<float>(10000, -3, 5, seed)).exact);
    EXPECT_FALSE(fitted(randomReals<double>(10000, -3, 5, seed)).exact);
  }
}

TEST(Lattice, OneWildPointAmongRegularOnes) {
  std::vector<double> xyz = randomOn<double>(30000, 0, 1000, [](double k) { return k / 100; });
  xyz[50000] = 1.0 / 3;
  const GridFit fit = fitted(xyz);
  EXPECT_FALSE(fit.exact);
  EXPECT_LE(fit.maxError[0], 10 * std::ldexp(1, -31));
}

TEST(Lattice, HandfulsOfPoints) {
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    const std::size_t count = 1 + seed % 9;
    fitted(randomReals<float>(count, -1, 1, seed));
    fitted(randomReals<double>(count, -1e3, 1e7, seed));
    EXPECT_TRUE(fitted(randomOn<float>(
                           count, -50, 50, [](double k) { return k / 10; }, seed))
                    .exact);
  }
}

}  // namespace
}  // namespace bspc::test
