// Cells of meshes and their arrays, through encode(), Decoder and join().

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "bspc/error.h"
#include "bspc/join.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/meshes.h"

namespace bspc {
namespace {

using test::Mesh;

/// A mesh as encode() takes it, with an array a cell that tells the cells' numbers.
struct MeshInput {
  explicit MeshInput(const Mesh& mesh) : xyz(test::asIntegers(mesh.points)), cells(mesh.cells) {
    numbers.name = "number";
    numbers.type = ScalarType::UInt32;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      for (unsigned b = 0; b < 4; ++b) {
        numbers.values.push_back(static_cast<std::uint8_t>(i >> (8 * b)));
      }
    }
  }
  PointSetView view(bool withArray = false) const {
    PointSetView view(xyz.data(), xyz.size() / 3);
    view.setMesh(&cells);
    if (withArray && cells.size() > 0) view.addCellArray(numbers.view());
    return view;
  }

  std::vector<std::int32_t> xyz;
  MeshCells cells;
  ArrayValues numbers;
};

Bytes encoded(const PointSetView& view, const EncodeOptions& options,
              EncodeReport* report = nullptr) {
  MemorySink sink;
  const EncodeReport done = encode(view, sink, options);
  if (report != nullptr) *report = done;
  return sink.take();
}

Decoder opened(const Bytes& file, bool partial = false) {
  OpenOptions options;
  options.allowPartial = partial;
  return Decoder(std::make_shared<MemorySource>(file), options);
}

std::vector<GridPoint> placesOf(const Decoder& decoder, const DecodedPoints& decoded) {
  std::vector<GridPoint> places(decoded.points.size());
  std::vector<std::int32_t> xyz(3 * places.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), xyz.data());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    places[i / 3][i % 3] = static_cast<std::uint32_t>(xyz[i]);
  }
  return places;
}

/// Faces by where their points are: what must be the same whatever the order.
std::vector<std::vector<GridPoint>> faceShapes(const std::vector<GridPoint>& points,
                                               const Cells& faces) {
  std::vector<std::vector<GridPoint>> shapes;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::vector<GridPoint> shape;
    for (const std::uint32_t v : faces[i]) shape.push_back(points[v]);
    std::vector<GridPoint> best = shape;
    for (std::size_t j = 0; j < shape.size(); ++j) {
      std::rotate(shape.begin(), shape.begin() + 1, shape.end());
      best = std::min(best, shape);
    }
    shapes.push_back(best);
  }
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

/// Compares through the orders that the report tells.
void expectSame(const MeshInput& input, const EncodeReport& report, const DecodedPoints& decoded) {
  const auto input_cell = [&](std::size_t sort, std::size_t i) {
    const Cells* sorts[] = {&input.cells.vertices, &input.cells.lines, &input.cells.faces};
    return (*sorts[sort])[i];
  };
  const Cells* sorts[] = {&decoded.mesh.vertices, &decoded.mesh.lines, &decoded.mesh.faces};
  const std::size_t counts[] = {input.cells.vertices.size(), input.cells.lines.size(),
                                input.cells.faces.size()};
  std::size_t before = 0;
  for (std::size_t sort = 0; sort < 3; ++sort) {
    ASSERT_EQ(sorts[sort]->size(), counts[sort]);
    for (std::size_t i = 0; i < sorts[sort]->size(); ++i) {
      std::vector<std::uint64_t> got;
      for (const std::uint32_t v : (*sorts[sort])[i]) got.push_back(report.order[v]);
      const auto given_cell = input_cell(sort, report.cellOrder[before + i] - before);
      std::vector<std::uint64_t> given(given_cell.begin(), given_cell.end());
      if (sort != 1) {
        // Vertex cells are sets, faces begin anywhere: the test of the coder looks at their sense.
        std::sort(got.begin(), got.end());
        std::sort(given.begin(), given.end());
      }
      ASSERT_EQ(got, given) << "sort " << sort << ", cell " << i;
    }
    before += counts[sort];
  }
}

std::vector<Mesh> meshes() {
  std::vector<Mesh> all = test::oddMeshes();
  all.push_back(test::torus(30, 20, true));
  all.push_back(test::remeshedSphere(3, 3));
  for (Mesh& mesh : all) {
    // int32 input: the corners of the whole grid are tested by the coder itself.
    for (GridPoint& p : mesh.points) {
      for (std::uint32_t& x : p) x &= 0x7FFFFFFF;
    }
  }
  return all;
}

class MeshFile : public testing::TestWithParam<Layout> {};

TEST_P(MeshFile, HasEveryCell) {
  for (const Mesh& mesh : meshes()) {
    SCOPED_TRACE(mesh.name);
    const MeshInput input(mesh);
    EncodeOptions options;
    options.layout = GetParam();
    options.wantOrder = true;
    EncodeReport report;
    const Bytes file = encoded(input.view(), options, &report);
    Decoder decoder = opened(file);
    EXPECT_EQ(decoder.info().mesh.faces, mesh.cells.faces.size());
    EXPECT_EQ(decoder.info().mesh.lines, mesh.cells.lines.size());
    EXPECT_EQ(decoder.info().mesh.vertices, mesh.cells.vertices.size());
    const DecodedPoints decoded = decoder.decode();
    expectSame(input, report, decoded);
    EXPECT_EQ(faceShapes(placesOf(decoder, decoded), decoded.mesh.faces),
              faceShapes(mesh.points, mesh.cells.faces));
  }
}

TEST_P(MeshFile, HasSeveralTiles) {
  const Mesh mesh = test::soup(test::terrain(4, 30));
  const MeshInput input(mesh);
  EncodeOptions options;
  options.layout = GetParam();
  options.tilePoints = 500;
  options.wantOrder = true;
  EncodeReport report;
  const Bytes file = encoded(input.view(), options, &report);
  EXPECT_GT(report.tiles, 5U);
  expectSame(input, report, opened(file).decode());
}

TEST_P(MeshFile, CarriesArraysOfCells) {
  for (const Mesh& mesh : meshes()) {
    SCOPED_TRACE(mesh.name);
    const MeshInput input(mesh);
    EncodeOptions options;
    options.layout = GetParam();
    options.wantOrder = true;
    EncodeReport report;
    const DecodedPoints decoded = opened(encoded(input.view(true), options, &report)).decode();
    if (mesh.cells.empty()) continue;
    ASSERT_EQ(decoded.cellArrays.size(), 1U);
    ASSERT_EQ(decoded.cellArrays[0].tuples(), mesh.cells.size());
    for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
      ASSERT_EQ(test::tupleOf(decoded.cellArrays[0], i),
                test::tupleOf(input.numbers, report.cellOrder[i]));
    }
  }
}

TEST_P(MeshFile, KeepsTheOrder) {
  for (const Mesh& mesh : meshes()) {
    SCOPED_TRACE(mesh.name);
    const MeshInput input(mesh);
    EncodeOptions options;
    options.layout = GetParam();
    options.keepOrder = true;
    options.tilePoints = 300;
    const Bytes file = encoded(input.view(true), options);
    Decoder decoder = opened(file);
    const DecodedPoints decoded = decoder.decode();
    EXPECT_EQ(placesOf(decoder, decoded), mesh.points);
    EXPECT_EQ(decoded.mesh.faces.indices, mesh.cells.faces.indices);
    EXPECT_EQ(decoded.mesh.faces.ends, mesh.cells.faces.ends);
    EXPECT_EQ(decoded.mesh.lines.indices, mesh.cells.lines.indices);
    EXPECT_EQ(decoded.mesh.vertices.indices, mesh.cells.vertices.indices);
    if (!mesh.cells.empty()) {
      EXPECT_EQ(decoded.cellArrays[0].values, input.numbers.values);
    }
  }
}

TEST_P(MeshFile, IsJoinedWithOthers) {
  std::vector<std::shared_ptr<ByteSource>> files;
  std::vector<Bytes> kept;
  std::vector<std::vector<GridPoint>> shapes;
  std::vector<Mesh> parts{test::terrain(1, 9), test::oddMeshes()[5], test::torus(9, 8, false)};
  std::uint32_t shift = 50000;
  for (Mesh& mesh : parts) {
    for (GridPoint& p : mesh.points) p[0] += shift;
    shift -= 20000;
    EncodeOptions options;
    if (!kept.empty()) options.grid = GridRequest::onGrid(opened(kept[0]).info().grid);
    options.tilePoints = 40;
    const MeshInput owned(mesh);
    kept.push_back(encoded(owned.view(true), options));
    for (const auto& shape : faceShapes(mesh.points, mesh.cells.faces)) shapes.push_back(shape);
  }
  files.reserve(kept.size());
  for (const Bytes& file : kept) files.push_back(std::make_shared<MemorySource>(file));
  MemorySink sink;
  JoinOptions options;
  options.layout = GetParam();
  join(files, sink, options);
  Decoder decoder = opened(sink.bytes());
  const DecodedPoints decoded = decoder.decode();
  std::sort(shapes.begin(), shapes.end());
  EXPECT_EQ(faceShapes(placesOf(decoder, decoded), decoded.mesh.faces), shapes);
  EXPECT_EQ(decoder.info().mesh.faces, shapes.size());
  ASSERT_EQ(decoded.cellArrays.size(), 1U);
  EXPECT_EQ(decoded.cellArrays[0].tuples(), decoded.mesh.size());
}

TEST_P(MeshFile, CutShortStillGivesItsPoints) {
  const MeshInput input(test::terrain(1, 9));
  EncodeOptions options;
  options.layout = GetParam();
  EncodeReport report;
  Bytes file = encoded(input.view(), options, &report);
  ASSERT_GT(report.meshBytes, 20U);
  file.resize(file.size() - report.meshBytes / 2 - (GetParam() == Layout::Streaming ? 20 : 0));
  EXPECT_THROW(opened(file), Error);
  Decoder decoder = opened(file, true);
  EXPECT_TRUE(decoder.info().mesh.missing);
  const DecodedPoints decoded = decoder.decode();
  EXPECT_EQ(decoded.points.size(), 100U);
  EXPECT_TRUE(decoded.mesh.empty());
}

TEST_P(MeshFile, DamagedIsAnError) {
  const MeshInput input(test::terrain(1, 5));
  EncodeOptions options;
  options.layout = GetParam();
  const Bytes file = encoded(input.view(true), options);
  for (std::size_t i = 0; i < file.size(); ++i) {
    Bytes damaged = file;
    damaged[i] ^= 0x11;
    EXPECT_THROW(opened(damaged).decode(), Error) << "byte " << i;
  }
}

TEST_P(MeshFile, FollowsItsFaces) {
  for (const Mesh& mesh : meshes()) {
    SCOPED_TRACE(mesh.name);
    const MeshInput input(mesh);
    EncodeOptions options;
    options.method = Method::Surface;
    options.layout = GetParam();
    options.wantOrder = true;
    EncodeReport report;
    const Bytes file = encoded(input.view(true), options, &report);
    Decoder decoder = opened(file);
    const DecodedPoints decoded = decoder.decode();
    expectSame(input, report, decoded);
    EXPECT_EQ(faceShapes(placesOf(decoder, decoded), decoded.mesh.faces),
              faceShapes(mesh.points, mesh.cells.faces));
    if (mesh.cells.empty()) continue;
    for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
      ASSERT_EQ(test::tupleOf(decoded.cellArrays[0], i),
                test::tupleOf(input.numbers, report.cellOrder[i]));
    }
  }
}

TEST_P(MeshFile, FollowsItsFacesNoFurtherThanItCan) {
  // Several tiles, kept order, levels: the faces are coded from the places of their points.
  const Mesh mesh = test::torus(20, 12, true);
  const MeshInput input(mesh);
  for (int way = 0; way < 3; ++way) {
    SCOPED_TRACE(way);
    EncodeOptions options;
    options.method = Method::Surface;
    options.layout = GetParam();
    options.keepOrder = way == 0;
    if (way == 1) options.tilePoints = 50;
    if (way == 2) options.layers = 3;
    const Bytes file = encoded(input.view(), options);
    Decoder decoder = opened(file);
    const DecodedPoints decoded = decoder.decode();
    EXPECT_EQ(faceShapes(placesOf(decoder, decoded), decoded.mesh.faces),
              faceShapes(mesh.points, mesh.cells.faces));
    DecodeOptions coarse;
    coarse.level = 0;
    if (way == 2) {
      EXPECT_EQ(decoder.decode(coarse).points.size(), 1U);
    }
  }
}

TEST_P(MeshFile, FollowsItsFacesIfThatIsShorter) {
  const Mesh mesh = test::smoothNet(30);
  const MeshInput input(mesh);
  EncodeOptions options;
  options.layout = GetParam();
  EncodeReport report;
  const Bytes shorter = encoded(input.view(), options, &report);
  EXPECT_EQ(report.method, Method::Surface);
  EXPECT_EQ(report.fileBytes, shorter.size());
  options.method = Method::Predictive;
  EXPECT_LT(shorter.size(), encoded(input.view(), options, &report).size());
  EXPECT_EQ(report.method, Method::Predictive);
  const Decoder decoder = opened(shorter);
  EXPECT_EQ(decoder.info().tiles[0].method, Method::Surface);
}

TEST_P(MeshFile, IsJoinedAlongItsFaces) {
  std::vector<std::shared_ptr<ByteSource>> files;
  std::vector<Bytes> kept;
  std::vector<std::vector<GridPoint>> shapes;
  for (std::uint32_t part = 0; part < 3; ++part) {
    Mesh mesh = part == 1 ? test::torus(9, 8, false) : test::terrain(part, 8);
    for (GridPoint& p : mesh.points) p[0] += 50000 - 20000 * part;
    for (const auto& shape : faceShapes(mesh.points, mesh.cells.faces)) shapes.push_back(shape);
    EncodeOptions options;
    options.method = part == 0 ? Method::Kd : Method::Surface;
    if (!kept.empty()) options.grid = GridRequest::onGrid(opened(kept[0]).info().grid);
    kept.push_back(encoded(MeshInput(mesh).view(), options));
  }
  files.reserve(kept.size());
  for (const Bytes& file : kept) files.push_back(std::make_shared<MemorySource>(file));
  MemorySink sink;
  JoinOptions options;
  options.layout = GetParam();
  join(files, sink, options);
  Decoder decoder = opened(sink.bytes());
  std::sort(shapes.begin(), shapes.end());
  const DecodedPoints decoded = decoder.decode();
  EXPECT_EQ(faceShapes(placesOf(decoder, decoded), decoded.mesh.faces), shapes);
}

TEST_P(MeshFile, DamagedAlongItsFacesIsAnError) {
  EncodeOptions options;
  options.layout = GetParam();
  options.method = Method::Surface;
  const Bytes file = encoded(MeshInput(test::terrain(1, 5)).view(true), options);
  for (std::size_t i = 0; i < file.size(); ++i) {
    Bytes damaged = file;
    damaged[i] ^= 0x11;
    EXPECT_THROW(opened(damaged).decode(), Error) << "byte " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, MeshFile,
                         testing::Values(Layout::Progressive, Layout::Streaming));

TEST(MeshFiles, PartsOfThePointsHaveNoCells) {
  const MeshInput input(test::terrain(1, 9));
  const Bytes file = encoded(input.view(true), {});
  Decoder decoder = opened(file);
  DecodeOptions box;
  box.box = Box{{0, 0, 0}, {500, 500, 500}};
  EXPECT_TRUE(decoder.decode(box).mesh.empty());
  DecodeOptions without;
  without.mesh = false;
  EXPECT_TRUE(decoder.decode(without).mesh.empty());
  EXPECT_EQ(decoder.decode().mesh.faces.size(), 162U);
}

TEST(MeshFiles, RefuseWhatDoesNotFit) {
  const Mesh mesh = test::terrain(1, 3);
  MeshInput input(mesh);
  EncodeOptions lossy;
  lossy.method = Method::Kd;
  lossy.stopPoints = 4;
  EXPECT_THROW(encoded(input.view(), lossy), Error);
  PointSetView view = input.view(true);
  view.addCellArray(input.numbers.view());  // the name twice
  EXPECT_THROW(encoded(view, {}), Error);
  input.cells.faces.add(std::vector<std::uint32_t>{0, 1, 16});
  EXPECT_THROW(encoded(input.view(), {}), Error);
}

TEST(MeshFiles, RefuseFacesOfPointsThatAreDropped) {
  const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, std::nanf(""), 0, 0, 2, 2, 2};
  MeshCells cells;
  cells.faces.add(std::vector<std::uint32_t>{0, 1, 2});
  cells.faces.add(std::vector<std::uint32_t>{1, 2, 4});
  PointSetView view(xyz.data(), 5);
  view.setMesh(&cells);
  EncodeOptions options;
  options.grid.dropNonFinite = true;
  options.wantOrder = true;
  EncodeReport report;
  const DecodedPoints decoded = opened(encoded(view, options, &report)).decode();
  EXPECT_EQ(decoded.mesh.faces.size(), 2U);
  for (const std::uint32_t v : decoded.mesh.faces.indices) EXPECT_NE(report.order[v], 3U);
  cells.faces.add(std::vector<std::uint32_t>{1, 3, 2});
  EXPECT_THROW(encoded(view, options), Error);
}

TEST(MeshFiles, AreTheSameForAnyNumberOfThreads) {
  const MeshInput input(test::soup(test::terrain(4, 20)));
  EncodeOptions options;
  options.tilePoints = 300;
  options.threads = 1;
  const Bytes one = encoded(input.view(), options);
  options.threads = 4;
  EXPECT_EQ(encoded(input.view(), options), one);
}

}  // namespace
}  // namespace bspc
