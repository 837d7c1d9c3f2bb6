#include "support/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace bspc::test {

namespace {

constexpr double kTurn = 6.283185307179586;

using Place = std::array<double, 3>;
using Face = std::vector<std::uint32_t>;

GridPoint onGrid(const Place& place, double scale) {
  GridPoint p{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = static_cast<std::uint32_t>(std::lround((place[k] + 2) * scale));
  }
  return p;
}

Mesh named(const char* name) {
  Mesh mesh;
  mesh.name = name;
  return mesh;
}

void addQuad(Mesh& mesh, const std::array<std::uint32_t, 4>& q, bool triangles, bool otherWay) {
  if (!triangles) {
    mesh.cells.faces.add(Face{q[0], q[1], q[2], q[3]});
  } else if (otherWay) {
    mesh.cells.faces.add(Face{q[0], q[1], q[3]});
    mesh.cells.faces.add(Face{q[1], q[2], q[3]});
  } else {
    mesh.cells.faces.add(Face{q[0], q[1], q[2]});
    mesh.cells.faces.add(Face{q[0], q[2], q[3]});
  }
}

/// Triangles over places, with what flipping edges needs.
class Triangulation {
 public:
  std::vector<Place> places;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  void icosahedron() {
    const double g = (1 + std::sqrt(5.0)) / 2;
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-g, g}) {
        places.push_back({0, a, b});
        places.push_back({a, b, 0});
        places.push_back({b, 0, a});
      }
    }
    // Faces are the triples of vertices at distance 2, turned outwards.
    for (std::uint32_t i = 0; i < 12; ++i) {
      for (std::uint32_t j = i + 1; j < 12; ++j) {
        for (std::uint32_t k = j + 1; k < 12; ++k) {
          if (near(i, j) && near(j, k) && near(i, k)) addOutwards(i, j, k);
        }
      }
    }
    normalise();
  }

  void subdivide() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), 0);
      if (fresh) {
        at->second = static_cast<std::uint32_t>(places.size());
        Place m{};
        for (std::size_t k = 0; k < 3; ++k) m[k] = (places[a][k] + places[b][k]) / 2;
        places.push_back(m);
      }
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
    normalise();
  }

  void normalise() {
    for (Place& p : places) {
      const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
      for (double& x : p) x /= length;
    }
  }

  /// Flips edges whose opposite angles add up to more than half a turn, until there are none.
  void flipToDelaunay() {
    for (int round = 0; round < 50; ++round) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> faceOf;
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          faceOf[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
        }
      }
      std::vector<bool> touched(triangles.size(), false);
      bool flipped = false;
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3 && !touched[t]; ++k) {
          const std::uint32_t a = triangles[t][k];
          const std::uint32_t b = triangles[t][(k + 1) % 3];
          const std::uint32_t c = triangles[t][(k + 2) % 3];
          const std::uint32_t other = faceOf.at({b, a});
          if (touched[other]) continue;
          const std::uint32_t d = opposite(other, a, b);
          if (faceOf.count({c, d}) > 0 || faceOf.count({d, c}) > 0) continue;
          if (angle(c, a, b) + angle(d, a, b) <= kTurn / 2 + 1e-9) continue;
          triangles[t] = {c, a, d};
          triangles[other] = {d, b, c};
          touched[t] = touched[other] = flipped = true;
        }
      }
      if (!flipped) return;
    }
  }

 private:
  bool near(std::uint32_t a, std::uint32_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += (places[a][k] - places[b][k]) * (places[a][k] - places[b][k]);
    }
    return sum < 4.5;
  }

  void addOutwards(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Place& p = places[a];
    const Place& q = places[b];
    const Place& r = places[c];
    const double volume = p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                          p[2] * (q[0] * r[1] - q[1] * r[0]);
    if (volume > 0) {
      triangles.push_back({a, b, c});
    } else {
      triangles.push_back({a, c, b});
    }
  }

  std::uint32_t opposite(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t v : triangles[t]) {
      if (v != a && v != b) return v;
    }
    return a;
  }

  double angle(std::uint32_t at, std::uint32_t a, std::uint32_t b) const {
    double dot = 0;
    double aa = 0;
    double bb = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = places[a][k] - places[at][k];
      const double y = places[b][k] - places[at][k];
      dot += x * y;
      aa += x * x;
      bb += y * y;
    }
    return std::acos(std::clamp(dot / std::sqrt(aa * bb), -1.0, 1.0));
  }
};

Mesh withFaces(const char* name, std::vector<GridPoint> points, const std::vector<Face>& faces) {
  Mesh mesh = named(name);
  mesh.points = std::move(points);
  for (const Face& face : faces) mesh.cells.faces.add(face);
  return mesh;
}

std::vector<GridPoint> line(std::uint32_t count) {
  std::vector<GridPoint> points;
  for (std::uint32_t i = 0; i < count; ++i) points.push_back({i * i % 17, i * 3 % 11, i});
  return points;
}

Mesh turnedAround(Mesh mesh, std::uint64_t seed) {
  mesh.name = "turned around";
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < mesh.cells.faces.size(); ++i) {
    if (random() % 2 == 0) continue;
    std::reverse(mesh.cells.faces.indices.begin() + mesh.cells.faces.first(i),
                 mesh.cells.faces.indices.begin() + mesh.cells.faces.ends[i]);
  }
  return mesh;
}

Mesh prism(std::uint32_t sides) {
  Mesh mesh = named("prism");
  Face bottom;
  Face top;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double turn = kTurn * i / sides;
    mesh.points.push_back(onGrid({std::cos(turn), std::sin(turn), 0}, 1000));
    mesh.points.push_back(onGrid({std::cos(turn), std::sin(turn), 1}, 1000));
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
    const std::uint32_t next = 2 * ((i + 1) % sides);
    mesh.cells.faces.add(Face{2 * i, next, next + 1, 2 * i + 1});
  }
  mesh.cells.faces.add(bottom);
  mesh.cells.faces.add(top);
  return mesh;
}

Mesh linesAndVertices() {
  Mesh mesh = terrain(5, 4);
  mesh.name = "lines and vertex cells";
  mesh.cells.lines.add(Face{0, 1, 2, 3, 4});
  mesh.cells.lines.add(Face{7, 3});
  mesh.cells.lines.add(Face{3});
  mesh.cells.lines.add(Face{});
  mesh.cells.lines.add(Face{2, 2, 2});
  mesh.cells.vertices.add(Face{8});
  mesh.cells.vertices.add(Face{1, 2, 9});
  mesh.cells.vertices.add(Face{1});
  mesh.cells.vertices.add(Face{});
  return mesh;
}

Mesh oneVertexCellEach() {
  Mesh mesh = named("a vertex cell a point");
  mesh.points = line(100);
  for (std::uint32_t i = 0; i < 100; ++i) mesh.cells.vertices.add(Face{(i * 37) % 100});
  return mesh;
}

}  // namespace

Mesh torus(std::uint32_t rings, std::uint32_t sides, bool triangles) {
  Mesh mesh = named(triangles ? "torus" : "torus of quadrilaterals");
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double u = kTurn * i / rings;
      const double v = kTurn * j / sides;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.points.push_back(onGrid({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)}, 1000));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t right = (i + 1) % rings;
      const std::uint32_t up = (j + 1) % sides;
      addQuad(mesh, {i * sides + j, right * sides + j, right * sides + up, i * sides + up},
              triangles, (i + j) % 2 == 0);
    }
  }
  return mesh;
}

Mesh terrain(std::uint64_t seed, std::uint32_t side) {
  Mesh mesh = named("terrain");
  std::mt19937_64 random(seed);
  for (std::uint32_t i = 0; i <= side; ++i) {
    for (std::uint32_t j = 0; j <= side; ++j) {
      mesh.points.push_back({100 * i + static_cast<std::uint32_t>(random() % 60),
                             100 * j + static_cast<std::uint32_t>(random() % 60),
                             static_cast<std::uint32_t>(200 + 90 * std::sin(0.3 * i + 0.2 * j))});
    }
  }
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::uint32_t at = i * (side + 1) + j;
      addQuad(mesh, {at, at + side + 1, at + side + 2, at + 1}, true, random() % 2 == 0);
    }
  }
  return mesh;
}

Mesh smoothNet(std::uint32_t side) {
  Mesh mesh = named("smooth net");
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      mesh.points.push_back({300 * i + 113 * j + i * i / 3 + j * j / 5,
                             270 * j + 51 * (side - i) + i * j / 5,
                             211 * i + 170 * (side - j) + i * i + i * i * j / 40 + j * j * j / 60});
    }
  }
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const std::uint32_t a = j * (side + 1) + i;
      addQuad(mesh, {a, a + 1, a + side + 2, a + side + 1}, true, false);
    }
  }
  return mesh;
}

Mesh remeshedSphere(std::uint64_t seed, unsigned levels) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Triangulation t;
  t.icosahedron();
  for (unsigned i = 0; i < levels; ++i) {
    t.subdivide();
    const double reach = 0.45 / std::sqrt(static_cast<double>(t.places.size()));
    for (Place& p : t.places) {
      for (double& x : p) x += reach * uniform(random);
    }
    t.normalise();
    t.flipToDelaunay();
  }
  std::array<double, 6> wave{};
  for (double& x : wave) x = 3 + 3 * uniform(random);
  Mesh mesh = named("remeshed sphere");
  for (const Place& p : t.places) {
    const double bump = 1 + 0.15 * std::sin(wave[0] * p[0] + wave[1] * p[1]) +
                        0.1 * std::sin(wave[2] * p[1] + wave[3] * p[2]);
    mesh.points.push_back(onGrid({p[0] * bump, p[1] * bump, p[2] * bump * 0.7}, 1000));
  }
  for (const auto& f : t.triangles) mesh.cells.faces.add({f.data(), 3});
  return mesh;
}

Mesh soup(Mesh mesh) {
  Mesh result = named("soup");
  for (std::size_t i = 0; i < mesh.cells.faces.size(); ++i) {
    Face face;
    for (const std::uint32_t v : mesh.cells.faces[i]) {
      face.push_back(static_cast<std::uint32_t>(result.points.size()));
      result.points.push_back(mesh.points[v]);
    }
    result.cells.faces.add(face);
  }
  return result;
}

Mesh shuffled(Mesh mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Face> faces;
  for (std::size_t i = 0; i < mesh.cells.faces.size(); ++i) {
    const Span<const std::uint32_t> face = mesh.cells.faces[i];
    faces.emplace_back(face.begin(), face.end());
    if (!face.empty()) {
      const auto start = static_cast<std::ptrdiff_t>(random() % face.size());
      std::rotate(faces.back().begin(), faces.back().begin() + start, faces.back().end());
    }
  }
  std::shuffle(faces.begin(), faces.end(), random);
  mesh.name += ", shuffled";
  mesh.cells.faces = {};
  for (const Face& face : faces) mesh.cells.faces.add(face);
  return mesh;
}

std::vector<Mesh> oddMeshes() {
  std::vector<Mesh> meshes;
  meshes.push_back(withFaces("nothing", {}, {}));
  meshes.push_back(withFaces("points only", line(7), {}));
  meshes.push_back(withFaces("one triangle", line(3), {{2, 0, 1}}));
  meshes.push_back(withFaces("isolated vertices", line(40), {{20, 7, 31}, {7, 20, 11}}));
  meshes.push_back(withFaces("two faces on one triangle", line(3), {{0, 1, 2}, {0, 2, 1}}));
  meshes.push_back(
      withFaces("a face twice", line(4), {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {1, 3, 2}}));
  meshes.push_back(
      withFaces("an edge of four faces", line(6), {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}}));
  meshes.push_back(withFaces("bow tie", line(5), {{0, 1, 2}, {2, 3, 4}}));
  meshes.push_back(withFaces("a triangle that hangs on three others by its vertices", line(60),
                             {{0, 1, 2}, {20, 21, 22}, {40, 41, 42}, {0, 20, 40}}));
  meshes.push_back(withFaces("faces of all sizes", line(20),
                             {{},
                              {3},
                              {4, 5},
                              {0, 0, 0},
                              {1, 1, 2},
                              {0, 1, 2, 3, 4, 5, 6, 7},
                              {8, 9, 8, 9},
                              {10, 11, 12, 13, 14, 15, 16, 17, 18, 19}}));
  meshes.push_back(withFaces("equal points", std::vector<GridPoint>(12, {5, 6, 7}),
                             {{0, 1, 2}, {2, 1, 3}, {9, 10, 11}, {4, 5, 6}}));
  meshes.push_back(withFaces("corners of the grid",
                             {{0, 0, 0},
                              {0xFFFFFFFF, 0, 0},
                              {0, 0xFFFFFFFF, 0},
                              {0, 0, 0xFFFFFFFF},
                              {1, 1, 1},
                              {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}},
                             {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 5, 2}, {4, 0, 5}}));
  meshes.push_back(prism(3));
  meshes.push_back(prism(17));
  meshes.push_back(turnedAround(torus(12, 7, true), 1));
  meshes.push_back(turnedAround(torus(12, 7, false), 2));
  meshes.push_back(soup(terrain(3, 6)));
  meshes.push_back(soup(torus(9, 6, false)));
  meshes.push_back(linesAndVertices());
  meshes.push_back(oneVertexCellEach());
  return meshes;
}

std::vector<std::vector<std::uint32_t>> canonical(const Cells& faces) {
  std::vector<std::vector<std::uint32_t>> result;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Face face(faces[i].begin(), faces[i].end());
    Face best = face;
    for (std::size_t j = 0; j < face.size(); ++j) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
      best = std::min(best, face);
    }
    result.push_back(best);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace bspc::test
