// A wish to stop is seen soon, whatever the file: how often decoding asks for it, counted against
// the work that bspc/limits.h says lies between.

#include <gtest/gtest.h>

#include <string>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/meshes.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

/// How often decoding the file calls back.
std::size_t callsOf(const Bytes& file, DecodeOptions options = {}) {
  std::size_t calls = 0;
  options.threads = 1;
  options.progress = [&calls](double) { return ++calls > 0; };
  test::open(file).decode(options);
  return calls;
}

/// What it has done by its own account when it is stopped at the n-th call.
double shareAt(std::size_t n, const Bytes& file) {
  double last = 0;
  DecodeOptions options;
  options.threads = 1;
  options.progress = [&](double share) {
    last = share;
    return --n > 0;
  };
  try {
    test::open(file).decode(options);
    ADD_FAILURE() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
  return last;
}

Bytes encodedBy(Method method, const std::vector<GridPoint>& points, unsigned layers) {
  EncodeOptions options;
  options.method = method;
  options.layers = layers;
  options.tilePoints = points.size();
  return test::encoded(points, options);
}

class Stop : public testing::TestWithParam<Method> {};

/// They come from a few bytes.
TEST_P(Stop, IsAskedForAmongEqualPoints) {
  constexpr std::size_t kPoints = 200000;
  const std::vector<GridPoint> points(kPoints, GridPoint{5, 5, 5});
  const Bytes file = encodedBy(GetParam(), points, 1);
  EXPECT_GE(callsOf(file), kPoints / 65536);
  EXPECT_LE(shareAt(2, file), 0.4);
}

/// Where there are no points yet.
TEST_P(Stop, IsAskedForInCoarseLayers) {
  constexpr std::size_t kPoints = 9000;
  if (GetParam() == Method::Surface || GetParam() == Method::Fast) return;  // have no cells there
  const Bytes file =
      encodedBy(GetParam(), test::randomPoints(1, kPoints, {65535, 65535, 65535}), 2);
  DecodeOptions coarse;
  coarse.level = 0;
  const DecodedPoints decoded = test::open(file).decode(coarse);
  ASSERT_GE(decoded.points.size(), 2000U);
  EXPECT_GE(callsOf(file, coarse), 2 + decoded.points.size() / 4096 + 1);
}

INSTANTIATE_TEST_SUITE_P(Methods, Stop,
                         testing::Values(Method::Kd, Method::Fast, Method::Bsp, Method::Octree,
                                         Method::GenCode, Method::Predictive),
                         [](const auto& test) { return std::string(methodName(test.param)); });

TEST(StopOfAMesh, IsAskedForAmongItsCells) {
  const test::Mesh mesh = test::terrain(3, 60);
  const std::vector<std::int32_t> xyz = test::asIntegers(mesh.points);
  for (const Method method : {Method::Kd, Method::Surface}) {
    for (const bool keepOrder : {false, true}) {
      EncodeOptions options;
      options.method = method;
      options.keepOrder = keepOrder;
      PointSetView points(xyz.data(), mesh.points.size());
      points.setMesh(&mesh.cells);
      const Bytes file = test::encoded(points, options);
      DecodeOptions pointsOnly;
      pointsOnly.mesh = false;
      EXPECT_GE(callsOf(file), callsOf(file, pointsOnly) + mesh.cells.faces.size() / 1024)
          << methodName(method) << (keepOrder ? ", in order" : "");
    }
  }
}

TEST(StopOfArrays, IsAskedForBeforeEach) {
  const std::vector<GridPoint> points = test::randomPoints(2, 100, {100, 100, 100});
  const std::vector<std::int32_t> xyz = test::asIntegers(points);
  std::vector<ArrayValues> arrays;
  for (const char* name : {"a", "b", "c", "d"}) {
    arrays.push_back(test::randomArray(name, ScalarType::UInt8, 1, points.size(), 1));
  }
  PointSetView view(xyz.data(), points.size());
  const Bytes none = test::encoded(view);
  for (const ArrayValues& array : arrays) view.addArray(array.view());
  EXPECT_GE(callsOf(test::encoded(view)), callsOf(none) + 4);
}

TEST(StopOfThreads, IsSeenByThemAll) {
  EncodeOptions encoding;
  encoding.method = Method::Kd;
  encoding.tilePoints = 2000;
  const Bytes file = test::encoded(test::randomPoints(3, 40000, {1023, 1023, 1023}), encoding);
  DecodeOptions options;
  options.threads = 3;
  options.progress = [](double share) { return share == 0; };
  try {
    test::open(file).decode(options);
    FAIL() << "did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

}  // namespace
}  // namespace bspc
