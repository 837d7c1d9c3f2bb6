#include "bspc/grid.h"

#include <cfloat>
#include <limits>

#include "grid/grid_test_support.h"

namespace bspc::test {
namespace {

Grid rational(std::int64_t base, std::int64_t p, std::int64_t q, ScalarType type) {
  Grid grid;
  grid.scalarType = type;
  for (Grid::Axis& axis : grid.axes) {
    axis.base = base;
    axis.numerator = p;
    axis.denominator = q;
  }
  return grid;
}

Grid affine(double origin, double step, ScalarType type) {
  Grid grid;
  grid.form = Grid::Form::Affine;
  grid.scalarType = type;
  for (Grid::Axis& axis : grid.axes) {
    axis.origin = origin;
    axis.step = step;
  }
  return grid;
}

TEST(Grid, RationalCoordinatesAreThoseOfTheDecimalText) {
  const Grid grid = rational(702718800, 1, 100, ScalarType::Float64);
  EXPECT_EQ(grid.coordinate(0, 12), 7027188.12);
  EXPECT_EQ(grid.coordinateOfMultiple(1, 1234), 12.34);
  EXPECT_EQ(grid.step(2), 0.01);
  EXPECT_EQ(rational(-3, 5, 2, ScalarType::Float64).coordinate(0, 1), -5);
}

TEST(Grid, AffineCoordinatesAreOriginPlusMultiples) {
  Grid grid = affine(0.1, 0.3, ScalarType::Float64);
  grid.axes[1].base = 5;
  EXPECT_EQ(grid.coordinate(1, 2), 0.1 + 7.0 * 0.3);
  EXPECT_EQ(grid.step(1), 0.3);
}

TEST(Grid, IndicesReachTheEndsOfTheirRange) {
  const Grid grid = rational(std::int64_t{1} << 62, 1, 1, ScalarType::Float64);
  EXPECT_EQ(grid.coordinate(0, UINT32_MAX), 4611686022722355199.0);
}

TEST(Grid, SameLatticeLooksAtStepsAndOriginsOnly) {
  const Grid grid = rational(0, 1, 100, ScalarType::Float64);
  EXPECT_TRUE(grid.sameLattice(rational(77, 1, 100, ScalarType::Float32)));
  EXPECT_FALSE(grid.sameLattice(rational(0, 1, 10, ScalarType::Float64)));
  EXPECT_FALSE(grid.sameLattice(affine(0, 0.01, ScalarType::Float64)));
  EXPECT_FALSE(affine(0, 1, ScalarType::Float64).sameLattice(affine(1, 1, ScalarType::Float64)));
  EXPECT_TRUE(affine(2, 1, ScalarType::Float64).sameLattice(affine(2, 1, ScalarType::Int8)));
}

TEST(Grid, ValidateRefusesFieldsOutOfRange) {
  const std::int64_t big = std::int64_t{1} << 62;
  rational(big, big, 1, ScalarType::Float64).validate();
  rational(-big, 1, big, ScalarType::Float64).validate();
  for (const Grid& grid : {
           rational(big + 1, 1, 1, ScalarType::Float64),
           rational(-big - 1, 1, 1, ScalarType::Float64),
           rational(0, 0, 1, ScalarType::Float64),
           rational(0, 1, -1, ScalarType::Float64),
           rational(0, 1, big + 1, ScalarType::Float64),
           rational(0, 2, 4, ScalarType::Float64),
           rational(0, (std::int64_t{1} << 53) + 1, 1, ScalarType::Float64),
           rational(0, 1, 1, ScalarType::Bit),
           affine(std::numeric_limits<double>::quiet_NaN(), 1, ScalarType::Float64),
           affine(std::numeric_limits<double>::infinity(), 1, ScalarType::Float64),
           affine(0, 0, ScalarType::Float64),
           affine(0, -1, ScalarType::Float64),
           affine(0, std::numeric_limits<double>::infinity(), ScalarType::Float64),
       }) {
    messageOf(ErrorCode::InvalidArgument, [&] { grid.validate(); });
  }
}

TEST(Grid, RestoredCoordinatesHaveTheScalarType) {
  EXPECT_EQ(restoredCoordinate(rational(0, 1, 10, ScalarType::Float32), 0, 1), double{0.1F});
  EXPECT_EQ(restoredCoordinate(rational(0, 1, 10, ScalarType::Float64), 0, 1), 0.1);
  EXPECT_EQ(restoredCoordinate(rational(0, 3, 2, ScalarType::Int32), 0, 1), 2);
  EXPECT_EQ(restoredCoordinate(rational(100, 2, 1, ScalarType::Int8), 0, 9), 127);
  EXPECT_EQ(restoredCoordinate(rational(-9, 1, 1, ScalarType::UInt16), 0, 0), 0);
  EXPECT_EQ(restoredCoordinate(affine(0, 1e39, ScalarType::Float32), 0, 1), double{FLT_MAX});
  // −1e−60 rounds to −0 as a float.
  const double tiny = restoredCoordinate(affine(-1e-60, 1, ScalarType::Float32), 0, 0);
  EXPECT_EQ(tiny, 0);
  EXPECT_FALSE(std::signbit(tiny));
}

TEST(Grid, RestorePositionsConvertsAndClamps) {
  const std::vector<GridPoint> points{{0, 1, 2}, {3, 4, UINT32_MAX}};
  const Grid grid = rational(-1, 3, 2, ScalarType::Float64);
  std::vector<double> doubles(6);
  restorePositions<double>(grid, points, doubles.data());
  EXPECT_EQ(doubles, (std::vector<double>{-1.5, 0, 1.5, 3, 4.5, 6442450941}));
  std::vector<std::uint8_t> bytes(6);
  restorePositions<std::uint8_t>(grid, points, bytes.data());
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0, 0, 2, 3, 5, 255}));
  std::vector<std::int64_t> longs(6);
  restorePositions<std::int64_t>(affine(0, 1e300, ScalarType::Float64), points, longs.data());
  EXPECT_EQ(longs[1], INT64_MAX);
  std::vector<std::uint64_t> unsignedLongs(6);
  restorePositions<std::uint64_t>(affine(-5, 1e300, ScalarType::Float64), points,
                                  unsignedLongs.data());
  EXPECT_EQ(unsignedLongs[0], 0U);
  EXPECT_EQ(unsignedLongs[1], UINT64_MAX);
}

TEST(GridRequest, RefusesWishesOutOfRange) {
  for (const unsigned bits : {0U, 33U}) {
    messageOf(ErrorCode::InvalidArgument, [&] { GridRequest::withBits(bits); });
  }
  for (const double precision : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity()}) {
    messageOf(ErrorCode::InvalidArgument, [&] { GridRequest::withPrecision(precision); });
  }
  messageOf(ErrorCode::InvalidArgument,
            [] { GridRequest::onGrid(affine(0, 0, ScalarType::Float64)); });
  GridRequest request;
  request.kind = GridRequest::Kind::Bits;
  const std::vector<float> xyz(3);
  messageOf(ErrorCode::InvalidArgument, [&] { fitGrid(viewOf(xyz), request); });
}

TEST(ScalarTypes, SizesAndNames) {
  EXPECT_EQ(scalarSize(ScalarType::Float32), 4U);
  EXPECT_EQ(scalarSize(ScalarType::UInt64), 8U);
  EXPECT_EQ(scalarSize(ScalarType::Int16), 2U);
  EXPECT_EQ(scalarSize(ScalarType::UInt8), 1U);
  EXPECT_EQ(scalarSize(ScalarType::Bit), 0U);
  EXPECT_EQ(scalarSize(ScalarType::String), 0U);
  EXPECT_STREQ(scalarName(ScalarType::Float32), "float32");
  EXPECT_STREQ(scalarName(ScalarType::UInt8), "uint8");
}

TEST(PointSetView, ReadsAnyTypeAtAnyStride) {
  struct Vertex {
    std::uint8_t tag;
    std::int16_t xyz[3];
  };
  const std::vector<Vertex> vertices{{1, {1, -2, 3}}, {2, {4, 5, -6}}};
  const PointSetView view(vertices[0].xyz, ScalarType::Int16, 2, sizeof(Vertex));
  EXPECT_EQ(view.position(1), (std::array<double, 3>{4, 5, -6}));
  EXPECT_TRUE(fitGrid(view, {}).exact);
  const std::vector<unsigned char> odd(1 + 3 * sizeof(double));
  EXPECT_EQ(PointSetView(odd.data() + 1, ScalarType::Float64, 1, 0).position(0)[2], 0);
}

TEST(PointSetView, RefusesWhatItCannotRead) {
  const std::vector<float> xyz(3);
  messageOf(ErrorCode::InvalidArgument, [&] { PointSetView(xyz.data(), ScalarType::Bit, 1, 0); });
  messageOf(ErrorCode::InvalidArgument,
            [&] { PointSetView(xyz.data(), ScalarType::Float32, 1, 11); });
  messageOf(ErrorCode::InvalidArgument, [] { PointSetView(nullptr, ScalarType::Float32, 1, 0); });
  EXPECT_EQ(PointSetView(xyz.data(), 1).strideBytes(), 12U);
}

}  // namespace
}  // namespace bspc::test
