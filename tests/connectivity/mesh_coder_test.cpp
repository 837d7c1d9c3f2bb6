#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bspc/error.h"
#include "connectivity/connectivity_coder.h"
#include "connectivity/mesh_preparation.h"
#include "connectivity/surface_faces.h"
#include "support/meshes.h"

namespace bspc::connectivity {
namespace {

using test::Mesh;

constexpr std::uint64_t kMemory = std::uint64_t{1} << 28;

std::vector<Mesh> allMeshes() {
  std::vector<Mesh> meshes = test::oddMeshes();
  meshes.push_back(test::torus(24, 12, true));
  meshes.push_back(test::torus(24, 12, false));
  meshes.push_back(test::terrain(1, 12));
  meshes.push_back(test::remeshedSphere(1, 3));
  meshes.push_back(test::soup(test::remeshedSphere(2, 2)));
  meshes.push_back(test::shuffled(test::terrain(2, 8), 9));
  return meshes;
}

double bitsPerFace(const Mesh& mesh, const CodingWishes& wishes) {
  const EncodedMesh encoded = encodeMesh({mesh.points}, mesh.cells, wishes);
  return 8.0 * static_cast<double>(encoded.payload.size()) /
         static_cast<double>(mesh.cells.faces.size());
}

std::vector<std::uint32_t> reordered(const Cells& cells, std::size_t i) {
  return {cells[i].begin(), cells[i].end()};
}

/// The same cycle of vertices, from any of them on.
bool sameCycle(Span<const std::uint32_t> a, Span<const std::uint32_t> b) {
  if (a.size() != b.size()) return false;
  if (a.empty()) return true;
  std::vector<std::uint32_t> turned(b.begin(), b.end());
  for (std::size_t j = 0; j < b.size(); ++j) {
    if (std::equal(turned.begin(), turned.end(), a.begin())) return true;
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
  }
  return false;
}

void expectSame(const Mesh& mesh, const EncodedMesh& encoded, const MeshCells& decoded) {
  // Points that were renumbered: number j was pointOrder[j].
  MeshCells cells = decoded;
  if (!encoded.pointOrder.empty()) {
    for (Cells* c : {&cells.faces, &cells.lines, &cells.vertices}) {
      for (std::uint32_t& i : c->indices) i = encoded.pointOrder[i];
    }
  }
  ASSERT_EQ(cells.faces.size(), mesh.cells.faces.size()) << mesh.name;
  const auto source = [](const std::vector<std::uint32_t>& order, std::size_t i) {
    return order.empty() ? i : order[i];
  };
  for (std::size_t i = 0; i < cells.faces.size(); ++i) {
    ASSERT_TRUE(sameCycle(cells.faces[i], mesh.cells.faces[source(encoded.faceOrder, i)]))
        << mesh.name << ", face " << i;
  }
  EXPECT_EQ(cells.lines.indices, mesh.cells.lines.indices) << mesh.name;
  EXPECT_EQ(cells.lines.ends, mesh.cells.lines.ends) << mesh.name;
  ASSERT_EQ(cells.vertices.size(), mesh.cells.vertices.size()) << mesh.name;
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    std::vector<std::uint32_t> given =
        reordered(mesh.cells.vertices, source(encoded.vertexOrder, i));
    std::vector<std::uint32_t> got = reordered(cells.vertices, i);
    std::sort(given.begin(), given.end());
    std::sort(got.begin(), got.end());
    EXPECT_EQ(got, given) << mesh.name;
  }
}

class MeshCoder : public testing::TestWithParam<CodingWishes> {};

TEST_P(MeshCoder, GivesBackEveryCell) {
  for (const Mesh& mesh : allMeshes()) {
    const EncodedMesh encoded = encodeMesh({mesh.points}, mesh.cells, GetParam());
    // Renumbering only swaps points at the same place, so the decoder's points are the same.
    expectSame(mesh, encoded, decodeMesh({mesh.points}, encoded.payload, kMemory));
    for (std::size_t j = 0; j < encoded.pointOrder.size(); ++j) {
      ASSERT_EQ(mesh.points[j], mesh.points[encoded.pointOrder[j]]) << mesh.name;
    }
  }
}

TEST_P(MeshCoder, IsSafeOnDamagedPayloads) {
  std::mt19937_64 random(4);
  for (const Mesh& mesh : test::oddMeshes()) {
    const Bytes payload = encodeMesh({mesh.points}, mesh.cells, GetParam()).payload;
    for (int i = 0; i < 24; ++i) {
      Bytes damaged = payload;
      if (i % 4 == 0) damaged.resize(random() % (damaged.size() + 1));
      for (std::size_t k = 0; k < 1 + static_cast<std::size_t>(i) % 3 && !damaged.empty(); ++k) {
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      }
      try {
        const MeshCells cells = decodeMesh({mesh.points}, damaged, 1 << 22);
        for (const Cells* c : {&cells.faces, &cells.lines, &cells.vertices}) {
          for (const std::uint32_t v : c->indices) ASSERT_LT(v, mesh.points.size());
        }
      } catch (const Error&) {
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Wishes, MeshCoder,
                         testing::Values(CodingWishes{1, false, false},
                                         CodingWishes{9, false, false},
                                         CodingWishes{9, false, true},
                                         CodingWishes{9, true, false}));

TEST(MeshCoder, KeepsTheOrderOnRequest) {
  CodingWishes wishes;
  wishes.keepOrder = true;
  for (const Mesh& mesh : allMeshes()) {
    const EncodedMesh encoded = encodeMesh({mesh.points}, mesh.cells, wishes);
    EXPECT_TRUE(encoded.faceOrder.empty() && encoded.vertexOrder.empty()) << mesh.name;
    const MeshCells decoded = decodeMesh({mesh.points}, encoded.payload, kMemory);
    EXPECT_EQ(decoded.faces.indices, mesh.cells.faces.indices) << mesh.name;
    EXPECT_EQ(decoded.faces.ends, mesh.cells.faces.ends) << mesh.name;
    EXPECT_EQ(decoded.lines.indices, mesh.cells.lines.indices) << mesh.name;
    EXPECT_EQ(decoded.vertices.indices, mesh.cells.vertices.indices) << mesh.name;
    EXPECT_EQ(decoded.vertices.ends, mesh.cells.vertices.ends) << mesh.name;
  }
}

TEST(MeshCoder, IsSafeOnRandomBytes) {
  std::mt19937_64 random(5);
  const Mesh mesh = test::terrain(1, 6);
  for (int i = 0; i < 150; ++i) {
    Bytes bytes(1 + random() % 60);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    bytes[0] &= 0x0F;  // a version that there is
    try {
      decodeMesh({mesh.points}, bytes, 1 << 22);
    } catch (const Error&) {
    }
  }
}

TEST(MeshCoder, StopsAtTheMemoryLimit) {
  const Mesh mesh = test::torus(60, 40, true);
  const Bytes payload = encodeMesh({mesh.points}, mesh.cells, {}).payload;
  try {
    decodeMesh({mesh.points}, payload, 500000);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::LimitExceeded);
  }
}

TEST(MeshCoder, RefusesPointsThatThereAreNot) {
  Mesh mesh = test::terrain(1, 2);
  mesh.cells.faces.add(std::vector<std::uint32_t>{0, 1, 9});
  EXPECT_THROW(encodeMesh({mesh.points}, mesh.cells, {}), Error);
}

TEST(MeshCoder, PredictsFacesFromTheGeometry) {
  EXPECT_LT(bitsPerFace(test::remeshedSphere(1, 5), {}), 0.35);
  EXPECT_LT(bitsPerFace(test::torus(100, 50, false), {}), 0.1);
}

TEST(MeshCoder, IsIndependentOfTheOrderOfFaces) {
  const Mesh mesh = test::remeshedSphere(1, 4);
  EXPECT_EQ(encodeMesh({mesh.points}, mesh.cells, {}).payload,
            encodeMesh({mesh.points}, test::shuffled(mesh, 1).cells, {}).payload);
}

TEST(MeshCoder, SplitsSoupsCheaply) {
  CodingWishes wishes;
  wishes.mayRenumber = true;
  EXPECT_LT(bitsPerFace(test::soup(test::remeshedSphere(1, 5)), wishes), 0.5);
}

/// Faces that method surface goes along.
Cells regularFaces(const Mesh& mesh) {
  const PreparedFaces prepared = prepareFaces(mesh.cells.faces);
  Cells regular;
  for (const std::uint32_t i : prepared.regular) regular.add(prepared.faces[i]);
  return regular;
}

TEST(SurfaceFaces, ComeBackInTheNumbersOfTheirVertices) {
  for (const Mesh& mesh : allMeshes()) {
    SCOPED_TRACE(mesh.name);
    const Cells regular = regularFaces(mesh);
    const auto points = static_cast<std::uint32_t>(mesh.points.size());
    entropy::SymbolWriter writer;
    const SurfaceFaces coded = encodeSurface(writer, regular, points);
    const Bytes payload = writer.finish();
    entropy::SymbolReader reader(payload);
    const SurfaceFaces decoded = decodeSurface(reader, points, [](std::uint64_t) {});
    reader.finish();
    EXPECT_EQ(decoded.faces.indices, coded.faces.indices);
    EXPECT_EQ(decoded.faces.ends, coded.faces.ends);
    ASSERT_EQ(decoded.vertices, coded.given.size());
    Cells given = decoded.faces;
    for (std::uint32_t& v : given.indices) v = coded.given[v];
    EXPECT_EQ(test::canonical(given), test::canonical(regular));
  }
}

TEST(SurfaceFaces, AreSafeOnDamagedPayloads) {
  std::mt19937_64 random(6);
  for (const Mesh& mesh : allMeshes()) {
    entropy::SymbolWriter writer;
    const auto points = static_cast<std::uint32_t>(mesh.points.size());
    encodeSurface(writer, regularFaces(mesh), points);
    const Bytes payload = writer.finish();
    for (int i = 0; i < 24; ++i) {
      Bytes damaged = payload;
      if (i % 4 == 0) damaged.resize(random() % (damaged.size() + 1));
      for (std::size_t k = 0; k < 1 + static_cast<std::size_t>(i) % 3 && !damaged.empty(); ++k) {
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      }
      try {
        entropy::SymbolReader reader(damaged);
        const SurfaceFaces decoded = decodeSurface(reader, points, [](std::uint64_t bytes) {
          if (bytes > (1 << 23)) throw Error(ErrorCode::LimitExceeded, "too much");
        });
        ASSERT_LE(decoded.vertices, points);
        for (const std::uint32_t v : decoded.faces.indices) ASSERT_LT(v, decoded.vertices);
      } catch (const Error&) {
      }
    }
  }
}

TEST(SurfaceFaces, CostLittleWhereTheyAreRegular) {
  const Mesh mesh = test::torus(100, 50, true);
  entropy::SymbolWriter writer;
  encodeSurface(writer, mesh.cells.faces, static_cast<std::uint32_t>(mesh.points.size()));
  EXPECT_LT(8.0 * static_cast<double>(writer.finish().size()),
            0.2 * static_cast<double>(mesh.cells.faces.size()));
}

TEST(MeshCoder, MeasuresAlongUnequalSteps) {
  Mesh mesh = test::remeshedSphere(1, 4);
  const double even = bitsPerFace(mesh, {});
  for (GridPoint& p : mesh.points) p[2] *= 64;
  const EncodedMesh stretched = encodeMesh({mesh.points, {1, 1, 1.0 / 64}}, mesh.cells, {});
  EXPECT_LT(8.0 * static_cast<double>(stretched.payload.size()) /
                static_cast<double>(mesh.cells.faces.size()),
            1.2 * even);
}

}  // namespace
}  // namespace bspc::connectivity
