// What every geometry method promises, checked for all of them over random and degenerate sets.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>

#include "bspc/error.h"
#include "connectivity/mesh_preparation.h"
#include "geometry/geometry_method.h"
#include "geometry/surface/surface_method.h"
#include "support/meshes.h"
#include "support/point_sets.h"
#include "support/tiles.h"

namespace bspc::geometry {
namespace {

using test::tileOf;

TileToDecode toDecode(const TileInput& tile, const EncodedTile& coded, unsigned layers) {
  TileToDecode decode;
  decode.points = tile.points.size();
  decode.extent = tile.extent;
  decode.layers = tile.layers;
  for (unsigned l = 0; l < layers; ++l) decode.payloads.emplace_back(coded.layers[l]);
  decode.maxPoints = std::numeric_limits<std::uint32_t>::max();
  decode.maxBytes = std::uint64_t{1} << 30;
  decode.maxDepth = 512;
  return decode;
}

/// Whether the method takes the grid of the tile at all.
bool suits(const GeometryMethod& method, const TileInput& tile) {
  const std::uint64_t longest = *std::max_element(tile.extent.begin(), tile.extent.end());
  return longest >> method.maxBits() == 0;
}

std::uint32_t largestOn(const GeometryMethod& method) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << method.maxBits()) - 1);
}

class EveryMethod : public testing::TestWithParam<Method> {
 protected:
  const GeometryMethod& method() const { return *findGeometryMethod(GetParam()); }
};

TEST_P(EveryMethod, RestoresEveryPointInTheOrderItReports) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    for (const unsigned layers : {1U, 2U, 5U, 32U}) {
      SCOPED_TRACE(set.name + ", layers: " + std::to_string(layers));
      const TileInput tile = tileOf(set.points, layers);
      if (!suits(method(), tile)) continue;
      const EncodedTile coded = method().encode(tile, {});
      ASSERT_EQ(coded.layers.size(), layers);
      ASSERT_EQ(coded.coarse.size(), layers - 1);
      const DecodedTile decoded = method().decode(toDecode(tile, coded, layers), {});
      ASSERT_EQ(decoded.points.size(), set.points.size());
      ASSERT_EQ(coded.order.size(), set.points.size());
      std::vector<bool> seen(set.points.size(), false);
      for (std::size_t j = 0; j < decoded.points.size(); ++j) {
        ASSERT_FALSE(seen[coded.order[j]]);
        seen[coded.order[j]] = true;
        GridPoint p = set.points[coded.order[j]];
        for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
        ASSERT_EQ(decoded.points[j], p);
      }
    }
  }
}

/// Every layer's representatives against the cells that the points are said to lie in.
void checkLayer(const GeometryMethod& method, const TileInput& tile, const EncodedTile& coded,
                unsigned layer) {
  TileToDecode coarse = toDecode(tile, coded, layer + 1);
  coarse.wantCounts = true;
  coarse.cellLevel = layer;
  const DecodedTile cells = method.decode(coarse, {});
  ASSERT_EQ(cells.points.size(), coded.coarse[layer].representatives);
  TileToDecode whole = toDecode(tile, coded, tile.layers);
  whole.cellLevel = layer;
  const DecodedTile all = method.decode(whole, {});
  std::map<std::uint64_t, std::size_t> representativeOf;
  for (std::size_t i = 0; i < cells.points.size(); ++i) {
    ASSERT_TRUE(representativeOf.emplace(cells.cellIds[i], i).second) << "a cell id came twice";
  }
  std::vector<std::uint64_t> members(cells.points.size(), 0);
  for (std::size_t j = 0; j < all.points.size(); ++j) {
    const auto found = representativeOf.find(all.cellIds[j]);
    ASSERT_NE(found, representativeOf.end());
    ++members[found->second];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = all.points[j][k];
      const std::uint32_t b = cells.points[found->second][k];
      ASSERT_LE(a > b ? a - b : b - a, coded.coarse[layer].spread);
      ASSERT_LE(b, tile.extent[k]);
    }
  }
  ASSERT_EQ(members, cells.counts);
}

TEST_P(EveryMethod, LayersStandForTheirPointsWithinTheirSpread) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    const TileInput tile = tileOf(set.points, 4);
    if (!suits(method(), tile)) continue;
    const EncodedTile coded = method().encode(tile, {});
    for (unsigned layer = 0; layer < 3; ++layer) {
      SCOPED_TRACE(set.name + ", layer " + std::to_string(layer));
      checkLayer(method(), tile, coded, layer);
    }
  }
}

TEST_P(EveryMethod, RefusesGridsBeyondItsOwnByName) {
  if (method().maxBits() == 32) {
    const std::vector<GridPoint> corners{{0, 0, 0}, {0, largestOn(method()), 0}};
    EXPECT_NO_THROW(method().encode(tileOf(corners, 1), {}));
    return;
  }
  const std::vector<GridPoint> points{{0, 0, 0}, {0, largestOn(method()) + 1, 0}};
  try {
    method().encode(tileOf(points, 1), {});
    FAIL() << "coded";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Unsupported);
    EXPECT_NE(std::string(error.what()).find("kd"), std::string::npos) << error.what();
  }
  const std::vector<GridPoint> largest{{0, 0, 0}, {0, largestOn(method()), 0}};
  EXPECT_NO_THROW(method().encode(tileOf(largest, 1), {}));
}

TEST_P(EveryMethod, StaysWithinItsLimits) {
  const std::vector<GridPoint> points(100000, GridPoint{1, 2, 3});
  const TileInput tile = tileOf(points, 1);
  const EncodedTile coded = method().encode(tile, {});
  TileToDecode decode = toDecode(tile, coded, 1);
  decode.maxPoints = 99999;
  EXPECT_THROW(method().decode(decode, {}), Error);
  decode.maxPoints = 100000;
  EXPECT_NO_THROW(method().decode(decode, {}));
  decode.maxBytes = 100000;
  EXPECT_THROW(method().decode(decode, {}), Error);
}

TEST_P(EveryMethod, NeverAllocatesOnTheWordOfTheFile) {
  // A claim of four thousand million points in no bytes at all meets the limit of memory.
  TileToDecode decode;
  decode.points = std::numeric_limits<std::uint32_t>::max();
  decode.extent = {1000, 1000, 1000};
  decode.payloads.emplace_back();
  decode.maxPoints = decode.points;
  decode.maxBytes = 1 << 20;
  decode.maxDepth = 512;
  EXPECT_THROW(method().decode(decode, {}), Error);
}

TEST_P(EveryMethod, SurvivesDamagedStreams) {
  const std::vector<GridPoint> points = test::scannedSphere(11, 600, 1023);
  const TileInput tile = tileOf(points, 3);
  const EncodedTile coded = method().encode(tile, {});
  std::mt19937_64 random(12);
  unsigned refused = 0;
  constexpr unsigned kTrials = 3000;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    std::vector<Bytes> layers = coded.layers;
    for (std::uint64_t flips = 1 + random() % 4; flips > 0; --flips) {
      Bytes& layer = layers[random() % layers.size()];
      if (layer.empty()) continue;
      layer[random() % layer.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
      if (random() % 4 == 0) layer.resize(random() % (layer.size() + 1));
    }
    TileToDecode decode = toDecode(tile, coded, 3);
    decode.payloads.assign(layers.begin(), layers.end());
    if (random() % 4 == 0) decode.points = 1 + random() % 5000;
    if (random() % 4 == 0) decode.extent[random() % 3] = static_cast<std::uint32_t>(random());
    decode.maxPoints = 10000;
    decode.maxBytes = 1 << 22;
    try {
      const DecodedTile decoded = method().decode(decode, {});
      for (const GridPoint& p : decoded.points) {
        for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(p[k], decode.extent[k]);
      }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kTrials / 2) << "damage is hardly ever noticed";
}

TEST_P(EveryMethod, SurvivesRandomBytes) {
  // Random bytes reach parameters and rules that this encoder never writes.
  std::mt19937_64 random(13);
  unsigned refused = 0;
  constexpr unsigned kTrials = 2000;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    std::vector<Bytes> payloads(1 + random() % 3);
    for (Bytes& payload : payloads) {
      payload.resize(random() % 200);
      for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
    }
    TileToDecode decode;
    decode.version = static_cast<unsigned>(random() % (method().version() + 1));
    decode.points = 1 + random() % 3000;
    decode.layers = static_cast<unsigned>(payloads.size() + random() % 2);
    for (std::uint32_t& v : decode.extent) {
      v = static_cast<std::uint32_t>(random() % (std::uint64_t{1} << (random() % 22)));
    }
    decode.payloads.assign(payloads.begin(), payloads.end());
    decode.maxPoints = 10000;
    decode.maxBytes = 1 << 22;
    decode.maxDepth = 512;
    try {
      for (const GridPoint& p : method().decode(decode, {}).points) {
        for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(p[k], decode.extent[k]);
      }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kTrials / 2) << "nonsense is hardly ever noticed";
}

INSTANTIATE_TEST_SUITE_P(Geometry, EveryMethod, testing::ValuesIn(availableMethods()),
                         [](const auto& method) { return methodName(method.param); });

/// A tile whose faces method surface goes along.
class SurfaceTile {
 public:
  explicit SurfaceTile(test::Mesh mesh) : mesh_(std::move(mesh)), tile_(tileOf(mesh_.points, 1)) {
    const connectivity::PreparedFaces prepared = connectivity::prepareFaces(mesh_.cells.faces);
    for (const std::uint32_t i : prepared.regular) faces_.add(prepared.faces[i]);
    tile_.wishes.faces = &faces_;
  }
  SurfaceTile(const SurfaceTile&) = delete;
  SurfaceTile& operator=(const SurfaceTile&) = delete;

  const test::Mesh& mesh() const { return mesh_; }
  const TileInput& tile() const { return tile_; }
  const Cells& faces() const { return faces_; }

 private:
  test::Mesh mesh_;
  Cells faces_;
  TileInput tile_;
};

std::vector<test::Mesh> surfaces() {
  std::vector<test::Mesh> meshes;
  for (test::Mesh& mesh : test::oddMeshes()) {
    if (!mesh.points.empty()) meshes.push_back(std::move(mesh));
  }
  meshes.push_back(test::torus(24, 12, false));
  meshes.push_back(test::remeshedSphere(1, 2));
  test::Mesh large = test::torus(24, 12, true);
  for (GridPoint& p : large.points) p[1] += p[1] % 2 == 0 ? 0 : 4000000000U;
  meshes.push_back(std::move(large));
  return meshes;
}

TEST(SurfaceMethodTest, RestoresPointsAndFaces) {
  const GeometryMethod& method = *findGeometryMethod(Method::Surface);
  for (const test::Mesh& mesh : surfaces()) {
    SCOPED_TRACE(mesh.name);
    const SurfaceTile surface(mesh);
    const TileInput& tile = surface.tile();
    const EncodedTile coded = method.encode(tile, {});
    const DecodedTile decoded = method.decode(toDecode(tile, coded, 1), {});
    ASSERT_EQ(decoded.points.size(), mesh.points.size());
    for (std::size_t j = 0; j < decoded.points.size(); ++j) {
      GridPoint p = mesh.points[coded.order[j]];
      for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
      ASSERT_EQ(decoded.points[j], p);
    }
    Cells faces = facesOfSurface(coded.layers[0], mesh.points.size(), std::uint64_t{1} << 28);
    EXPECT_EQ(faces.indices, coded.faces.indices);
    for (std::uint32_t& v : faces.indices) v = coded.order[v];
    EXPECT_EQ(test::canonical(faces), test::canonical(surface.faces()));
  }
}

TEST(SurfaceMethodTest, SurvivesDamagedStreams) {
  const GeometryMethod& method = *findGeometryMethod(Method::Surface);
  std::mt19937_64 random(14);
  for (const test::Mesh& mesh : surfaces()) {
    const SurfaceTile surface(mesh);
    const EncodedTile coded = method.encode(surface.tile(), {});
    for (unsigned trial = 0; trial < 12; ++trial) {
      Bytes payload = coded.layers[0];
      for (std::uint64_t flips = 1 + random() % 4; flips > 0 && !payload.empty(); --flips) {
        payload[random() % payload.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
        if (random() % 4 == 0) payload.resize(random() % (payload.size() + 1));
      }
      TileToDecode decode = toDecode(surface.tile(), coded, 1);
      decode.payloads.assign(1, payload);
      if (random() % 4 == 0) decode.points = 1 + random() % 5000;
      if (random() % 4 == 0) decode.extent[random() % 3] = static_cast<std::uint32_t>(random());
      decode.maxPoints = 10000;
      decode.maxBytes = 1 << 24;
      try {
        for (const GridPoint& p : method.decode(decode, {}).points) {
          for (std::size_t k = 0; k < 3; ++k) ASSERT_LE(p[k], decode.extent[k]);
        }
      } catch (const Error&) {
      }
    }
  }
}

TEST(SurfaceMethodTest, StopsAtTheMemoryLimit) {
  const GeometryMethod& method = *findGeometryMethod(Method::Surface);
  const SurfaceTile surface(test::torus(60, 40, true));
  const EncodedTile coded = method.encode(surface.tile(), {});
  TileToDecode decode = toDecode(surface.tile(), coded, 1);
  decode.maxBytes = std::uint64_t{9} << 19;
  EXPECT_THROW(method.decode(decode, {}), Error);
  EXPECT_THROW(facesOfSurface(coded.layers[0], decode.points, std::uint64_t{4} << 20), Error);
}

TEST(SurfaceMethodTest, PredictsVerticesAlongTheFaces) {
  const SurfaceTile surface(test::smoothNet(30));
  const EncodedTile along = findGeometryMethod(Method::Surface)->encode(surface.tile(), {});
  TileInput alone = surface.tile();
  alone.wishes.effort = 9;
  const EncodedTile octree = findGeometryMethod(Method::Predictive)->encode(alone, {});
  EXPECT_LT(along.layers[0].size(), octree.layers[0].size() * 3 / 5);
}

}  // namespace
}  // namespace bspc::geometry
