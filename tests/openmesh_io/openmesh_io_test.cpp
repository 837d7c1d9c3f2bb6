// .bspc files through OpenMesh's own functions.

#include "bspc/openmesh_io.h"

#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "support/meshes.h"

namespace bspc::openmesh {
namespace {

using OpenMesh::IO::Options;
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

template <class M>
M made(const test::Mesh& from) {
  M mesh;
  std::vector<OpenMesh::VertexHandle> handles;
  for (const GridPoint& p : from.points) {
    handles.push_back(mesh.add_vertex(typename M::Point(p[0] * 0.25, p[1] * 0.25, p[2] * 0.25)));
  }
  for (std::size_t i = 0; i < from.cells.faces.size(); ++i) {
    std::vector<OpenMesh::VertexHandle> face;
    for (const std::uint32_t v : from.cells.faces[i]) face.push_back(handles[v]);
    mesh.add_face(face);
  }
  return mesh;
}

using Shape = std::vector<std::array<double, 3>>;

/// Faces by the places of their corners, from the smallest on, sorted; and the single vertices.
template <class M>
std::vector<Shape> shapesOf(const M& mesh) {
  std::vector<Shape> shapes;
  const auto place = [&](OpenMesh::VertexHandle v) {
    const auto& p = mesh.point(v);
    return std::array<double, 3>{p[0], p[1], p[2]};
  };
  for (const auto face : mesh.faces()) {
    Shape shape;
    for (auto v = mesh.cfv_iter(face); v.is_valid(); ++v) shape.push_back(place(*v));
    std::rotate(shape.begin(), std::min_element(shape.begin(), shape.end()), shape.end());
    shapes.push_back(shape);
  }
  for (const auto vertex : mesh.vertices()) shapes.push_back({place(vertex)});
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

class Silence {
 public:
  Silence() { omerr().disable(); }
  ~Silence() { omerr().enable(); }
};

std::string path(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("bspc_openmesh_" + name)).string();
}

/// A file that is gone at the end of the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : name_(path(name)) {
    std::filesystem::remove(name_);
  }
  ~TemporaryFile() { std::filesystem::remove(name_); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

template <class M>
void expectRoundTrip(const M& mesh) {
  std::stringstream stream;
  ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, stream, ".bspc"));
  M restored;
  Options options;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(restored, stream, ".bspc", options));
  EXPECT_EQ(restored.n_vertices(), mesh.n_vertices());
  EXPECT_EQ(restored.n_faces(), mesh.n_faces());
  EXPECT_EQ(shapesOf(restored), shapesOf(mesh));
}

TEST(OpenMeshIo, ReadsWhatItWroteToAFile) {
  const TemporaryFile file("file.bspc");
  const TriMesh mesh = made<TriMesh>(test::remeshedSphere(1, 3));
  ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, file.name()));
  TriMesh restored;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(restored, file.name()));
  EXPECT_EQ(shapesOf(restored), shapesOf(mesh));
  EXPECT_LT(std::filesystem::file_size(file.name()), 5000U);
}

TEST(OpenMeshIo, ErrorInAFileIsReportedAndLeavesTheMeshEmpty) {
  const Silence silence;
  const TemporaryFile file("error.bspc");
  const TriMesh mesh = made<TriMesh>(test::terrain(1, 5));
  ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, file.name()));
  std::filesystem::resize_file(file.name(), std::filesystem::file_size(file.name()) - 9);
  TriMesh restored;
  EXPECT_FALSE(OpenMesh::IO::read_mesh(restored, file.name()));
  EXPECT_EQ(restored.n_vertices(), 0U);
  EXPECT_FALSE(OpenMesh::IO::read_mesh(restored, path("not there.bspc")));
  EXPECT_FALSE(OpenMesh::IO::write_mesh(mesh, path("no folder/mesh.bspc")));
}

TEST(OpenMeshIo, StreamsOfTrianglesAndPolygons) {
  expectRoundTrip(made<TriMesh>(test::torus(20, 12, true)));
  expectRoundTrip(made<TriMesh>(test::terrain(2, 9)));
  expectRoundTrip(made<PolyMesh>(test::torus(20, 12, false)));
  expectRoundTrip(made<DoubleMesh>(test::torus(9, 7, false)));
  expectRoundTrip(TriMesh());
  TriMesh points;
  for (int i = 0; i < 10; ++i) points.add_vertex({float(i), 0, 1});
  expectRoundTrip(points);
}

TEST(OpenMeshIo, StreamErrorIsReported) {
  const Silence silence;
  std::stringstream stream;
  ASSERT_TRUE(OpenMesh::IO::write_mesh(made<TriMesh>(test::terrain(1, 5)), stream, ".bspc"));
  const std::string good = stream.str();
  std::mt19937 random(1);
  for (int i = 0; i < 40; ++i) {
    std::string bad = good;
    if (i % 2 == 0) bad.resize(random() % bad.size());
    if (i % 2 == 1) bad[random() % bad.size()] ^= 0x40;
    std::stringstream damaged(bad);
    TriMesh mesh;
    Options options;
    EXPECT_FALSE(OpenMesh::IO::read_mesh(mesh, damaged, ".bspc", options));
    EXPECT_EQ(mesh.n_vertices(), 0U);
  }
  std::stringstream full;
  full.setstate(std::ios::badbit);
  EXPECT_FALSE(OpenMesh::IO::write_mesh(TriMesh(), full, ".bspc"));
}

TEST(OpenMeshIo, CarriesAttributesThatAreAskedFor) {
  PolyMesh mesh = made<PolyMesh>(test::torus(12, 8, false));
  mesh.request_vertex_normals();
  mesh.request_vertex_colors();
  mesh.request_vertex_texcoords2D();
  mesh.request_face_normals();
  mesh.request_face_colors();
  mesh.update_normals();
  for (const auto v : mesh.vertices()) {
    const auto i = static_cast<unsigned>(v.idx());
    mesh.set_color(v, PolyMesh::Color(static_cast<unsigned char>(i * 7), 3, 200));
    mesh.set_texcoord2D(v, {0.01F * static_cast<float>(i), 0.5F});
  }
  for (const auto f : mesh.faces()) {
    mesh.set_color(f, PolyMesh::Color(1, static_cast<unsigned char>(f.idx()), 2));
  }
  const Options all = Options::VertexNormal | Options::VertexColor | Options::VertexTexCoord |
                      Options::FaceNormal | Options::FaceColor;
  WriteSettings settings;
  settings.encoding.keepOrder = true;
  std::stringstream stream;
  ASSERT_TRUE(writeMesh(mesh, stream, all, settings));

  PolyMesh restored;
  restored.request_vertex_normals();
  restored.request_vertex_colors();
  restored.request_vertex_texcoords2D();
  restored.request_face_normals();
  restored.request_face_colors();
  Options options = all;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(restored, stream, ".bspc", options));
  EXPECT_TRUE(options.check(all));
  EXPECT_FALSE(options.vertex_has_status());
  for (const auto v : mesh.vertices()) {
    EXPECT_EQ(restored.point(v), mesh.point(v));
    EXPECT_EQ(restored.normal(v), mesh.normal(v));
    EXPECT_EQ(restored.color(v), mesh.color(v));
    EXPECT_EQ(restored.texcoord2D(v), mesh.texcoord2D(v));
  }
  for (const auto f : mesh.faces()) {
    EXPECT_EQ(restored.normal(f), mesh.normal(f));
    EXPECT_EQ(restored.color(f), mesh.color(f));
    EXPECT_EQ(*restored.cfv_iter(f), *mesh.cfv_iter(f));
  }
}

TEST(OpenMeshIo, CarriesStatusAndProperties) {
  TriMesh mesh = made<TriMesh>(test::terrain(3, 6));
  mesh.request_vertex_status();
  mesh.request_face_status();
  OpenMesh::VPropHandleT<double> weight;
  OpenMesh::FPropHandleT<OpenMesh::Vec3i> key;
  mesh.add_property(weight, "weight");
  mesh.add_property(key, "key");
  mesh.property(weight).set_persistent(true);
  mesh.property(key).set_persistent(true);
  for (const auto v : mesh.vertices()) {
    mesh.property(weight, v) = std::sqrt(v.idx());
    mesh.status(v).set_selected(v.idx() % 3 == 0);
  }
  for (const auto f : mesh.faces()) mesh.property(key, f) = OpenMesh::Vec3i(f.idx(), 1, -f.idx());
  WriteSettings settings;
  settings.encoding.originalIds = true;
  std::stringstream stream;
  ASSERT_TRUE(writeMesh(mesh, stream, Options::Status, settings));

  TriMesh restored;
  Options options = Options::Status;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(restored, stream, ".bspc", options));
  EXPECT_TRUE(options.check(Options::Status | Options::Custom));
  OpenMesh::VPropHandleT<double> restoredWeight;
  OpenMesh::VPropHandleT<std::uint64_t> original;
  OpenMesh::FPropHandleT<OpenMesh::Vec3i> restoredKey;
  ASSERT_TRUE(restored.get_property_handle(restoredWeight, "weight"));
  ASSERT_TRUE(restored.get_property_handle(original, "OriginalPointIds"));
  ASSERT_TRUE(restored.get_property_handle(restoredKey, "key"));
  for (const auto v : restored.vertices()) {
    const OpenMesh::VertexHandle was(static_cast<int>(restored.property(original, v)));
    EXPECT_EQ(restored.point(v), mesh.point(was));
    EXPECT_EQ(restored.property(restoredWeight, v), mesh.property(weight, was));
    EXPECT_EQ(restored.status(v).selected(), mesh.status(was).selected());
  }
  for (const auto f : restored.faces()) {
    const OpenMesh::FaceHandle was(restored.property(restoredKey, f)[0]);
    EXPECT_EQ(restored.calc_centroid(f), mesh.calc_centroid(was));
  }
}

TEST(OpenMeshIo, RefusesWhatItCannotStore) {
  const Silence silence;
  TriMesh mesh = made<TriMesh>(test::terrain(3, 3));
  std::stringstream stream;
  EXPECT_FALSE(writeMesh(mesh, stream, Options::VertexNormal));  // it has none
  EXPECT_FALSE(writeMesh(mesh, stream, Options::FaceTexCoord));
  OpenMesh::EPropHandleT<float> crease;
  mesh.add_property(crease, "crease");
  EXPECT_TRUE(writeMesh(mesh, stream));
  mesh.property(crease).set_persistent(true);
  EXPECT_FALSE(writeMesh(mesh, stream));
}

TEST(OpenMeshIo, KeepsDoublePrecision) {
  DoubleMesh mesh;
  std::vector<OpenMesh::VertexHandle> face;
  face.reserve(4);
  for (int i = 0; i < 4; ++i) {
    face.push_back(mesh.add_vertex({7e6 + 0.001 * i, 5e5 + 0.002 * i * i, 0.1 * i}));
  }
  mesh.add_face(face);
  expectRoundTrip(mesh);
  std::stringstream stream;
  ASSERT_TRUE(writeMesh(mesh, stream));
  std::stringstream log;
  omlog().connect(log);
  omlog().enable();
  PolyMesh floats;
  Options options;
  EXPECT_TRUE(readMesh(floats, stream, options));
  omlog().disconnect(log);
  EXPECT_NE(log.str().find("double precision"), std::string::npos);
}

TEST(OpenMeshIo, LeavesDeletedElementsOut) {
  TriMesh mesh = made<TriMesh>(test::terrain(4, 6));
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  mesh.delete_vertex(OpenMesh::VertexHandle(8), false);
  mesh.delete_face(OpenMesh::FaceHandle(40), true);
  std::stringstream stream;
  ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, stream, ".bspc"));
  TriMesh restored;
  Options options;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(restored, stream, ".bspc", options));
  mesh.garbage_collection();
  EXPECT_EQ(shapesOf(restored), shapesOf(mesh));
}

TEST(OpenMeshIo, GivesFacesThatAreNoSurfaceVerticesOfTheirOwn) {
  // Three faces at one edge: no mesh of OpenMesh, but a file may have them.
  const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0};
  const std::vector<float> heights{1, 2, 3, 4, 5};
  MeshCells cells;
  cells.faces.add(std::vector<std::uint32_t>{0, 1, 2});
  cells.faces.add(std::vector<std::uint32_t>{1, 0, 3});
  cells.faces.add(std::vector<std::uint32_t>{0, 1, 4});
  PointSetView view(xyz.data(), 5);
  ArrayView array;
  array.name = "height";
  array.tuples = 5;
  array.data = heights.data();
  view.addArray(array);
  view.setMesh(&cells);
  MemorySink sink;
  encode(view, sink);
  std::stringstream stream(std::string(sink.bytes().begin(), sink.bytes().end()));
  TriMesh mesh;
  Options options;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, stream, ".bspc", options));
  EXPECT_EQ(mesh.n_faces(), 3U);
  EXPECT_EQ(mesh.n_vertices(), 8U);
  OpenMesh::VPropHandleT<float> height;
  ASSERT_TRUE(mesh.get_property_handle(height, "height"));
  for (const auto v : mesh.vertices()) {
    const auto p = mesh.point(v);
    const float expected = p[0] == 1    ? 2.0F
                           : p[1] == 1  ? 3.0F
                           : p[2] == 1  ? 4.0F
                           : p[1] == -1 ? 5.0F
                                        : 1.0F;
    EXPECT_EQ(mesh.property(height, v), expected);
  }
}

TEST(OpenMeshIo, KnowsItsNames) {
  EXPECT_TRUE(OpenMesh::IO::IOManager().can_read("bspc"));
  EXPECT_TRUE(OpenMesh::IO::IOManager().can_write("mesh.BSPC"));
  EXPECT_FALSE(OpenMesh::IO::IOManager().can_read("xbspc"));
}

/// The models of scripts/models.sh, where they have been fetched.
TEST(OpenMeshIo, RestoresRealModels) {
  const std::filesystem::path folder =
      std::filesystem::path(BSPC_SOURCE_DIR) / "build" / "demo" / "data" / "meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "scripts/models.sh fetches the models";
  for (const char* name :
       {"anchor", "bull",    "cactus",   "cow",    "cube_quad", "dino",       "elephant",
        "elk",    "fandisk", "femur",    "hand",   "handle",    "head",       "homer",
        "joint",  "knot1",   "mushroom", "pinion", "rotor",     "triceratops"}) {
    SCOPED_TRACE(name);
    PolyMesh mesh;
    ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, (folder / (std::string(name) + ".off")).string()));
    // These lie on no lattice, so they come back within float spacing; handles are kept to compare.
    WriteSettings settings;
    settings.encoding.keepOrder = true;
    std::stringstream stream;
    ASSERT_TRUE(writeMesh(mesh, stream, {}, settings));
    PolyMesh restored;
    Options options;
    ASSERT_TRUE(readMesh(restored, stream, options));
    ASSERT_EQ(restored.n_vertices(), mesh.n_vertices());
    ASSERT_EQ(restored.n_faces(), mesh.n_faces());
    for (const auto v : mesh.vertices()) {
      const float room = 1e-5F * (1 + mesh.point(v).max_abs());
      EXPECT_LE((restored.point(v) - mesh.point(v)).max_abs(), room);
    }
    for (const auto f : mesh.faces()) {
      auto back = restored.cfv_iter(f);
      for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v, ++back) EXPECT_EQ(*back, *v);
    }
  }
}

}  // namespace
}  // namespace bspc::openmesh
