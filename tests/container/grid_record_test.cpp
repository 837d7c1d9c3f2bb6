#include "container/grid_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bspc/error.h"

namespace bspc::container {
namespace {

Bytes written(const Grid& grid) {
  ByteWriter out;
  writeGrid(out, grid);
  return out.take();
}

void expectSame(const Grid& grid) {
  const Bytes bytes = written(grid);
  ByteReader in(bytes, "grid", 0);
  const Grid back = readGrid(in);
  in.expectEnd();
  EXPECT_EQ(back.form, grid.form);
  EXPECT_EQ(back.scalarType, grid.scalarType);
  for (std::size_t k = 0; k < 3; ++k) {
    const Grid::Axis& a = back.axes[k];
    const Grid::Axis& b = grid.axes[k];
    EXPECT_EQ(a.base, b.base);
    if (grid.form == Grid::Form::Rational) {
      EXPECT_EQ(a.numerator, b.numerator);
      EXPECT_EQ(a.denominator, b.denominator);
    } else {
      EXPECT_EQ(a.origin, b.origin);
      EXPECT_EQ(std::signbit(a.origin), std::signbit(b.origin));
      EXPECT_EQ(a.step, b.step);
    }
  }
}

Grid rational(std::int64_t base, std::int64_t p, std::int64_t q) {
  Grid grid;
  for (Grid::Axis& axis : grid.axes) {
    axis.base = base;
    axis.numerator = p;
    axis.denominator = q;
  }
  return grid;
}

TEST(GridRecord, RationalGridsComeBack) {
  expectSame(Grid());
  expectSame(rational(-12345, 1, 100));
  expectSame(rational(702718800, 1, 1000));
  expectSame(rational(-(std::int64_t{1} << 62), std::int64_t{1} << 62, 1));
  expectSame(rational(std::int64_t{1} << 62, 1, std::int64_t{1} << 62));
  expectSame(rational(5, 3, 40));
  Grid mixed = rational(0, 1, 10);
  mixed.axes[2].denominator = 1000;
  mixed.scalarType = ScalarType::Int16;
  expectSame(mixed);
}

TEST(GridRecord, AffineGridsComeBack) {
  std::mt19937_64 random(1);
  for (unsigned trial = 0; trial < 2000; ++trial) {
    Grid grid;
    grid.form = Grid::Form::Affine;
    grid.scalarType = ScalarType::Float64;
    const bool narrow = trial % 2 == 0;
    for (Grid::Axis& axis : grid.axes) {
      const double origin = (static_cast<double>(random() >> 11) - 0x1p52) * 0x1p-20;
      const double step = static_cast<double>(1 + (random() >> 11)) * 0x1p-70;
      axis.origin = narrow ? double{static_cast<float>(origin)} : origin;
      axis.step = narrow ? double{static_cast<float>(step)} : step;
      axis.base = trial % 3 == 0 ? static_cast<std::int64_t>(random() % 1000) - 500 : 0;
    }
    if (trial % 5 == 0) grid.axes[1].step = grid.axes[2].step = grid.axes[0].step;
    if (trial % 7 == 0) grid.axes[1].origin = 0;
    expectSame(grid);
  }
}

TEST(GridRecord, CommonGridsAreShort) {
  EXPECT_LE(written(Grid()).size(), 4U);                        // integers from 0 on
  EXPECT_LE(written(rational(702718800, 1, 100)).size(), 19U);  // UTM centimetres
  Grid bits;
  bits.form = Grid::Form::Affine;
  for (Grid::Axis& axis : bits.axes) {
    axis.origin = double{-1.2345678F};
    axis.step = double{0.0012345678F};
  }
  EXPECT_LE(written(bits).size(), 19U);
}

TEST(GridRecord, AnyBytesAreSafe) {
  std::mt19937_64 random(2);
  unsigned accepted = 0;
  for (unsigned trial = 0; trial < 20000; ++trial) {
    Bytes bytes(random() % 60);
    for (std::uint8_t& b : bytes)
      b = static_cast<std::uint8_t>(random() % (trial % 2 == 0 ? 256 : 4));
    ByteReader in(bytes, "grid", 0);
    try {
      const Grid grid = readGrid(in);
      EXPECT_NO_THROW(grid.validate());
      ++accepted;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(accepted, 0U);
}

}  // namespace
}  // namespace bspc::container
