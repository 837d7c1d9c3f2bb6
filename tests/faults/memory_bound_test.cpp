// What decoding allocates, counted, against the bound that bspc/limits.h promises.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "faults/counted_memory.h"
#include "support/array_sets.h"
#include "support/meshes.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

constexpr std::uint64_t kKilobyte = 1024;

/// Decodes the file under limits of memory from far too low to enough: what is allocated stays
/// within the limit (twice that on several threads), four times the file, and `fixed` for each
/// thread, what the tables of models take.
void expectBound(const Bytes& file, const DecodeOptions& options, std::uint64_t fixed) {
  bool isRefused = false;
  bool isDecoded = false;
  for (std::uint64_t limit = 16 * kKilobyte; !isDecoded; limit += limit / 2) {
    ASSERT_LT(limit, std::uint64_t{1} << 28) << "no limit is enough";
    OpenOptions opening;
    opening.limits.memoryBytes = limit;
    const test::PeakOfMemory peak;
    try {
      test::open(file, opening).decode(options);
      isDecoded = true;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::LimitExceeded) << error.what();
      isRefused = true;
    }
    const std::uint64_t times = options.threads > 1 ? 2 : 1;
    ASSERT_LE(peak.bytes(), times * limit + 4 * file.size() + options.threads * fixed)
        << "limit " << limit;
  }
  EXPECT_TRUE(isRefused);
}

/// Of the models, for each method.
std::uint64_t fixedBytes(Method method) {
  return (method == Method::Predictive ? 3072 : 256) * kKilobyte;
}

class MemoryOfMethod : public testing::TestWithParam<Method> {};

TEST_P(MemoryOfMethod, StaysWithinTheLimit) {
  const bool slow = GetParam() == Method::Predictive || GetParam() == Method::Bsp;
  const std::vector<std::vector<GridPoint>> sets{
      std::vector<GridPoint>(slow ? 20000 : 40000, GridPoint{1, 2, 3}),
      test::randomPoints(3, slow ? 1500 : 20000, {1023, 1023, 1023})};
  for (const std::vector<GridPoint>& points : sets) {
    for (const unsigned layers : {1U, 4U}) {
      EncodeOptions encoding;
      encoding.method = GetParam();
      encoding.layers = layers;
      const Bytes file = test::encoded(points, encoding);
      DecodeOptions options;
      options.threads = 1;
      SCOPED_TRACE(std::to_string(layers) + " layers");
      expectBound(file, options, fixedBytes(GetParam()));
      options.wantCounts = true;
      options.cellLevel = layers - 1;
      expectBound(file, options, fixedBytes(GetParam()));
    }
  }
}

TEST(MemoryOfThreads, StaysWithinTwiceTheLimit) {
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    EncodeOptions encoding;
    encoding.method = Method::Octree;
    encoding.tilePoints = 5000;
    encoding.layers = 3;
    encoding.layout = layout;
    const Bytes file = test::encoded(test::randomPoints(4, 40000, {1023, 1023, 1023}), encoding);
    DecodeOptions options;
    options.threads = 3;
    expectBound(file, options, fixedBytes(Method::Octree));
  }
}

/// Shares of the memory would be too small for a tile if all threads that are wished for had one.
TEST(MemoryOfThreads, SufficesForAnyNumberOfThem) {
  EncodeOptions encoding;
  encoding.method = Method::Octree;
  encoding.tilePoints = 5000;
  const std::vector<GridPoint> points = test::randomPoints(5, 40000, {1023, 1023, 1023});
  const Bytes file = test::encoded(points, encoding);
  OpenOptions opening;
  opening.limits.memoryBytes = 4096 * kKilobyte;
  for (const unsigned threads : {1U, 2U, 64U}) {
    DecodeOptions options;
    options.threads = threads;
    EXPECT_EQ(test::open(file, opening).decode(options).points.size(), points.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, MemoryOfMethod, testing::ValuesIn(availableMethods()),
                         [](const auto& test) { return std::string(methodName(test.param)); });

TEST(MemoryOfArrays, StaysWithinTheLimit) {
  const std::vector<GridPoint> points = test::scannedSphere(5, 2000, 4000);
  const std::vector<std::int32_t> xyz = test::asIntegers(points);
  for (const unsigned effort : {2U, 7U}) {
    for (const ArrayValues& array : test::arraysOfAllTypes(points.size())) {
      PointSetView view(xyz.data(), points.size());
      view.addArray(array.view());
      EncodeOptions encoding;
      encoding.method = Method::Kd;
      if (effort == 2) encoding.keepOrder = true;
      const Bytes file = test::encoded(view, encoding);
      DecodeOptions options;
      options.threads = 1;
      SCOPED_TRACE(array.name);
      expectBound(file, options, 4096 * kKilobyte);
    }
  }
}

TEST(MemoryOfMeshes, StaysWithinTheLimit) {
  for (test::Mesh mesh : {test::torus(40, 30, true), test::soup(test::torus(20, 20, false)),
                          test::remeshedSphere(3, 3)}) {
    mesh.cells.lines = mesh.cells.faces;
    mesh.cells.vertices = mesh.cells.faces;
    const std::vector<std::int32_t> xyz = test::asIntegers(mesh.points);
    for (const Method method : {Method::Kd, Method::Surface}) {
      PointSetView view(xyz.data(), mesh.points.size());
      view.setMesh(&mesh.cells);
      EncodeOptions encoding;
      encoding.method = method;
      encoding.keepOrder = method == Method::Kd;
      const Bytes file = test::encoded(view, encoding);
      DecodeOptions options;
      options.threads = 1;
      SCOPED_TRACE(mesh.name + methodName(method));
      expectBound(file, options, 1024 * kKilobyte);
    }
  }
}

}  // namespace
}  // namespace bspc
