// Floats that come back bit for bit, whatever they are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "bspc/error.h"
#include "bspc/join.h"
#include "codec/codec_support.h"
#include "grid/float_order.h"

namespace bspc {
namespace {

template <class T>
ScalarType typeOf() {
  return sizeof(T) == 4 ? ScalarType::Float32 : ScalarType::Float64;
}

/// Numbers of every kind: zeros of both signs, denormal, tiny, huge and usual ones.
template <class T>
std::vector<T> awkwardNumbers(std::size_t points) {
  using Limits = std::numeric_limits<T>;
  const std::vector<T> special{T(0),
                               -T(0),
                               Limits::denorm_min(),
                               -Limits::min(),
                               Limits::max(),
                               Limits::lowest(),
                               Limits::min(),
                               T(1) / T(3),
                               -Limits::denorm_min() * 5,
                               T(1e-30),
                               T(-12345.678901),
                               Limits::epsilon()};
  std::mt19937_64 random(11);
  std::vector<T> xyz;
  for (std::size_t i = 0; i < 3 * points; ++i) {
    xyz.push_back(random() % 3 == 0
                      ? special[random() % special.size()]
                      : T(std::ldexp(double(random() % 100000), int(random() % 40))) / T(7));
  }
  return xyz;
}

template <class T>
std::vector<std::string> bitsOfPoints(const std::vector<T>& xyz) {
  std::vector<std::string> points;
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    points.emplace_back(reinterpret_cast<const char*>(&xyz[i]), 3 * sizeof(T));
  }
  std::sort(points.begin(), points.end());
  return points;
}

template <class T>
std::vector<T> decodedNumbers(const Bytes& file, const DecodeOptions& options = {}) {
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode(options);
  std::vector<T> xyz(3 * decoded.points.size());
  restorePositions(decoder.info().grid, decoded, xyz.data());
  return xyz;
}

template <class T>
class ExactFloats : public testing::Test {
 protected:
  static PointSetView view(const std::vector<T>& xyz) {
    return {xyz.data(), typeOf<T>(), xyz.size() / 3, 0};
  }
};
using Floats = testing::Types<float, double>;
TYPED_TEST_SUITE(ExactFloats, Floats);

TYPED_TEST(ExactFloats, ComeBackBitForBitByEveryMethod) {
  const auto xyz = awkwardNumbers<TypeParam>(700);
  for (const Method method : {Method::Fast, Method::Kd}) {
    for (const unsigned layers : {1U, 3U}) {
      EncodeOptions options;
      options.method = method;
      options.layers = layers;
      options.tilePoints = 300;
      options.grid = GridRequest::exactFloats();
      EncodeReport report;
      const Bytes file = test::encoded(this->view(xyz), options, &report);
      EXPECT_TRUE(report.exact);
      EXPECT_EQ(report.grid.form, Grid::Form::FloatBits);
      EXPECT_EQ(bitsOfPoints(decodedNumbers<TypeParam>(file)), bitsOfPoints(xyz));
      EXPECT_TRUE(test::open(file).info().arrays.empty());
      EXPECT_EQ(test::open(file).info().geometryBytes, report.geometryBytes);
    }
  }
}

TYPED_TEST(ExactFloats, OfABoxAreThoseInside) {
  const auto xyz = awkwardNumbers<TypeParam>(700);
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  options.tilePoints = 100;
  const Bytes file = test::encoded(this->view(xyz), options);
  for (const double bound : {double(xyz[4]), 1e5, 0.0, 1e300}) {
    DecodeOptions query;
    const double infinity = std::numeric_limits<double>::infinity();
    query.box = Box{{-infinity, -infinity, -bound}, {infinity, bound, infinity}};
    std::vector<TypeParam> inside;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      if (xyz[i + 1] > bound || xyz[i + 2] < -bound) continue;
      inside.insert(inside.end(), {xyz[i], xyz[i + 1], xyz[i + 2]});
    }
    EXPECT_EQ(bitsOfPoints(decodedNumbers<TypeParam>(file, query)), bitsOfPoints(inside)) << bound;
  }
}

TYPED_TEST(ExactFloats, OnALatticeKeepTheLattice) {
  std::vector<TypeParam> xyz(300);
  for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = TypeParam(i % 17) / 4;
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  EncodeReport report;
  const Bytes file = test::encoded(this->view(xyz), options, &report);
  EXPECT_EQ(report.grid.form, Grid::Form::Rational);
  EXPECT_EQ(bitsOfPoints(decodedNumbers<TypeParam>(file)), bitsOfPoints(xyz));
  xyz[7] = -TypeParam(0);
  const Bytes withMinus = test::encoded(this->view(xyz), options, &report);
  EXPECT_EQ(report.grid.form, Grid::Form::FloatBits);
  EXPECT_EQ(bitsOfPoints(decodedNumbers<TypeParam>(withMinus)), bitsOfPoints(xyz));
}

TYPED_TEST(ExactFloats, AreJoinedOnOneGrid) {
  const auto a = awkwardNumbers<TypeParam>(200);
  std::vector<TypeParam> b(300);
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = TypeParam(i) / 3;
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  const Bytes first = test::encoded(this->view(a), options);
  options.grid = GridRequest::onGrid(test::open(first).info().grid);
  const Bytes second = test::encoded(this->view(b), options);
  MemorySink sink;
  join({std::make_shared<MemorySource>(second), std::make_shared<MemorySource>(first)}, sink);
  std::vector<TypeParam> both = a;
  both.insert(both.end(), b.begin(), b.end());
  EXPECT_EQ(bitsOfPoints(decodedNumbers<TypeParam>(sink.bytes())), bitsOfPoints(both));
}

TYPED_TEST(ExactFloats, KeepTheOrderAndLeaveOutWhatIsNotFinite) {
  auto xyz = awkwardNumbers<TypeParam>(300);
  xyz[30] = std::numeric_limits<TypeParam>::infinity();
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  options.keepOrder = true;
  MemorySink sink;
  EXPECT_THROW(encode(this->view(xyz), sink, options), Error);
  options.grid.dropNonFinite = true;
  const Bytes file = test::encoded(this->view(xyz), options);
  std::vector<TypeParam> kept = xyz;
  kept.erase(kept.begin() + 30, kept.begin() + 33);
  const std::vector<TypeParam> decoded = decodedNumbers<TypeParam>(file);
  ASSERT_EQ(decoded.size(), kept.size());
  EXPECT_EQ(std::memcmp(decoded.data(), kept.data(), kept.size() * sizeof(TypeParam)), 0);
}

TYPED_TEST(ExactFloats, CannotBeStoppedEarly) {
  const auto xyz = awkwardNumbers<TypeParam>(50);
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  options.method = Method::Kd;
  options.stopPoints = 3;
  MemorySink sink;
  EXPECT_THROW(encode(this->view(xyz), sink, options), Error);
}

TEST(ExactFloatGrid, IsNotThatOfTheOtherType) {
  const std::vector<float> xyz{-0.0F, 1, 2};
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  EncodeReport report;
  test::encoded(PointSetView(xyz.data(), 1), options, &report);
  Grid doubles = report.grid;
  doubles.scalarType = ScalarType::Float64;
  EXPECT_FALSE(report.grid.sameLattice(doubles));
  options.grid = GridRequest::onGrid(doubles);
  MemorySink sink;
  EXPECT_THROW(encode(PointSetView(xyz.data(), 1), sink, options), Error);
}

TEST(ExactFloatGrid, IntegersStayWholeNumbers) {
  const std::vector<std::int32_t> xyz{-5, 1, 2};
  EncodeOptions options;
  options.grid = GridRequest::exactFloats();
  EncodeReport report;
  test::encoded(PointSetView(xyz.data(), 1), options, &report);
  EXPECT_EQ(report.grid.form, Grid::Form::Rational);
  EXPECT_TRUE(report.exact);
}

TEST(FloatOrder, GrowsWithTheNumbers) {
  using lattice::orderOf;
  const std::vector<double> ascending{
      std::numeric_limits<double>::lowest(), -1, -1e-310, -0.0, 0.0, 5e-324, 1,
      std::numeric_limits<double>::max()};
  for (std::size_t i = 1; i < ascending.size(); ++i) {
    EXPECT_LT(orderOf(ascending[i - 1]), orderOf(ascending[i]));
    EXPECT_LE(orderOf(float(ascending[i - 1] > 1e38    ? 1e38
                            : ascending[i - 1] < -1e38 ? -1e38
                                                       : ascending[i - 1])),
              orderOf(float(ascending[i] > 1e38 ? 1e38 : ascending[i])));
  }
  for (const double x : ascending) {
    const double back = lattice::doubleOfOrder(orderOf(x));
    EXPECT_EQ(back, x);
    EXPECT_EQ(std::signbit(back), std::signbit(x));
  }
}

}  // namespace
}  // namespace bspc
