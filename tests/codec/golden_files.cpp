#include "codec/golden_files.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>

#include "geometry/geometry_method.h"
#include "support/array_sets.h"

namespace bspc::test {

namespace {

/// A hilly terrain on a regular lattice, in integers: the same on every machine.
std::vector<double> terrain(unsigned side, double scale, double offset) {
  std::vector<double> xyz;
  for (unsigned y = 0; y < side; ++y) {
    for (unsigned x = 0; x < side; ++x) {
      const unsigned hill = (x * (side - x) / 8 + y * (side - y) / 5 + (x * y) % 7) % 1000;
      xyz.insert(xyz.end(), {offset + 4 * x * scale, offset + 4 * y * scale, hill * scale});
    }
  }
  return xyz;
}

/// Faces between the points of terrain(): quadrilaterals here, triangles there, with a hole, one
/// turned around, one there twice, and points without any.
MeshCells terrainFaces(unsigned side) {
  MeshCells cells;
  const auto add = [&](std::vector<std::uint32_t> face) { cells.faces.add(face); };
  for (unsigned y = 0; y + 3 < side; ++y) {
    for (unsigned x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      if (x == y && x % 7 == 3) continue;
      if (x > side / 2) {
        add({a, a + 1, a + side + 1, a + side});
      } else if ((x * y) % 3 == 1) {
        add({a, a + 1, a + side});
        add({a + 1, a + side + 1, a + side});
      } else {
        add({a, a + 1, a + side + 1});
        add({a, a + side + 1, a + side});
      }
    }
  }
  std::reverse(cells.faces.indices.begin(), cells.faces.indices.begin() + 3);
  add({0, 1, side + 1});
  return cells;
}

/// Triangles between the points of terrain(), their diagonals this way and that.
MeshCells terrainTriangles(unsigned side) {
  MeshCells cells;
  const auto add = [&](std::vector<std::uint32_t> face) { cells.faces.add(face); };
  for (unsigned y = 0; y + 1 < side; ++y) {
    for (unsigned x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      const std::uint32_t across = (x + y) % 3 == 0 ? a + side : a + side + 1;
      add({a, a + 1, across});
      add({across == a + side ? a + 1 : a, a + side + 1, a + side});
    }
  }
  return cells;
}

std::vector<double> noise(unsigned count, std::uint64_t range) {
  std::mt19937_64 random(2026);
  std::vector<double> xyz;
  for (unsigned i = 0; i < 3 * count; ++i) xyz.push_back(static_cast<double>(random() % range));
  return xyz;
}

/// What a depth camera sees of a ball before a wall, in no order of rows, and some points beside.
std::vector<double> rangeImage(std::int64_t width, std::int64_t height) {
  std::vector<double> xyz;
  const auto add = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    xyz.insert(xyz.end(), {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  };
  for (std::int64_t i = 0; i < width * height; ++i) {
    const std::int64_t pixel = i * 1009 % (width * height);
    const std::int64_t u = pixel % width - width / 2;
    const std::int64_t v = pixel / width - height / 2;
    if (pixel % 41 == 7) continue;
    std::int64_t rank = 40 + (3 * u + 2 * v) / 20;
    const std::int64_t toBall = (u - 10) * (u - 10) + (v + 5) * (v + 5);
    if (toBall < 200) rank = 12 + toBall / 60;
    const std::int64_t z = 900 + 13 * rank;
    // Pixels are seen at multiples of 1/70, the middle of the picture at 2000.
    add((2 * u * z + 280070) / 140, (2 * v * z + 280070) / 140, z);
  }
  for (std::int64_t i = 0; i < 12; ++i)
    add(1500 + i * 377 % 900, 1600 + i * 211 % 700, 950 + 31 * i);
  return xyz;
}

/// A terrain in finer steps, the lowest of which say nothing.
std::vector<double> scanned(unsigned side) {
  std::vector<double> xyz = terrain(side, 256, 0);
  std::mt19937_64 random(2026);
  for (double& x : xyz) x += static_cast<double>(random() % 100);
  return xyz;
}

/// Copies of points behind two planes, a few of them a step off or missing.
std::vector<double> mirrored(unsigned count) {
  std::vector<double> xyz;
  for (unsigned i = 0; i < count; ++i) {
    const double x = i * 37 % 50;
    const double y = i * 53 % 80;
    const double z = i * 29 % 30;
    xyz.insert(xyz.end(), {x, y, z, 101 - x, y, z + (i % 8 == 3 ? 1 : 0)});
    if (i % 5 != 2) xyz.insert(xyz.end(), {x, 170 - y, z, 101 - x, 170 - y, z});
  }
  return xyz;
}

/// A lattice that is no multiple of the grid's steps.
std::vector<double> skewLattice(unsigned side) {
  std::vector<double> xyz;
  for (unsigned y = 0; y < side; ++y) {
    for (unsigned x = 0; x < side; ++x) {
      const unsigned hill = (x * (side - x) + y * (side - y)) / 2;
      for (const unsigned v : {x, y, hill}) {
        const unsigned place = (v * 2371 + 500) / 1000;
        xyz.push_back(place);
      }
    }
  }
  return xyz;
}

/// Smooth and random values of several types.
std::vector<ArrayValues> goldenArrays(std::size_t count) {
  std::vector<ArrayValues> arrays = arraysOfAllTypes(count);
  ArrayValues height;
  height.name = "smooth";
  height.type = ScalarType::UInt16;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t v = 1000 + i % 12 * 3 + i / 12 * 7;
    height.values.push_back(static_cast<std::uint8_t>(v));
    height.values.push_back(static_cast<std::uint8_t>(v >> 8));
  }
  arrays.push_back(std::move(height));
  return arrays;
}

}  // namespace

std::vector<GoldenFile> goldenFiles() {
  std::vector<GoldenFile> files;
  for (const Method method : availableMethods()) {
    const std::string name = methodName(method);
    if (method == Method::Surface) continue;  // without faces it is nothing of its own
    const auto add = [&](const std::string& what, std::vector<double> xyz, ScalarType type,
                         Layout layout, unsigned layers, const GridRequest& grid) {
      GoldenFile file{
          std::string(name).append("_").append(what), std::move(xyz), type, {}, {}, {}, {}};
      file.options.method = method;
      file.options.layout = layout;
      file.options.layers = layers;
      file.options.grid = grid;
      files.push_back(std::move(file));
      return &files.back();
    };
    const GridRequest any = GridRequest::automatic();
    add("terrain", terrain(40, 1, 0), ScalarType::Float32, Layout::Progressive, 1, any);
    add("terrain_layers", terrain(70, 1, -100), ScalarType::Float32, Layout::Progressive, 4, any);
    add("terrain_streaming", terrain(20, 1, 7), ScalarType::Float32, Layout::Streaming, 2, any);
    add("terrain_bits", terrain(20, 0.125, -3), ScalarType::Float64, Layout::Progressive, 1,
        GridRequest::withBits(9));
    add("noise", noise(300, std::uint64_t{1} << geometry::findGeometryMethod(method)->maxBits()),
        ScalarType::Float64, Layout::Progressive, 2, any);
    add("crowd", noise(3000, 12), ScalarType::Float32, Layout::Progressive, 1, any);
    add("one_point", {1, 2, 3}, ScalarType::Float32, Layout::Progressive, 1, any);
    if (method == Method::Predictive) {
      for (const auto& [what, xyz] :
           {std::pair{"range_image", rangeImage(76, 60)}, std::pair{"mirrored", mirrored(12)},
            std::pair{"lattice", skewLattice(20)}}) {
        add(what, xyz, ScalarType::Float32, Layout::Progressive, 1, any);
      }
      for (const unsigned effort : {5U, 7U}) {
        add("scan_effort_" + std::to_string(effort), scanned(24), ScalarType::Float32,
            Layout::Progressive, 1, any)
            ->options.effort = effort;
      }
    }
    if (method == Method::Fast || method == Method::Kd) {
      GoldenFile* arrays =
          add("arrays", terrain(12, 1, 0), ScalarType::Float32, Layout::Progressive, 2, any);
      arrays->arrays = goldenArrays(144);
      arrays->options.keepOrder = method == Method::Kd;
      arrays->options.metadata.crs = "EPSG:25832";
      arrays->options.metadata.entries = {{"title", "terrain"}};
    }
    add("empty", {}, ScalarType::Float32, Layout::Progressive, 1, any);
  }
  for (const Method method : {Method::Kd, Method::Surface}) {
    GoldenFile file{std::string(methodName(method)).append("_mesh"),
                    terrain(30, 1, 0),
                    ScalarType::Float32,
                    {},
                    {},
                    terrainFaces(30),
                    {}};
    file.options.method = method;
    files.push_back(std::move(file));
  }
  GoldenFile values{"surface_mesh_arrays",
                    terrain(9, 1, 0),
                    ScalarType::Float32,
                    {},
                    {},
                    terrainTriangles(9),
                    {}};
  values.cellArrays = goldenArrays(values.cells.faces.size());
  values.options.method = Method::Surface;
  files.push_back(std::move(values));
  return files;
}

std::string goldenPath(const std::string& name) {
  const std::string changed = BSPC_TEST_DATA "/golden/" + name + ".bspc";
  return std::ifstream(changed) ? changed : BSPC_TEST_DATA "/frozen_1.0/" + name + ".bspc";
}

Bytes readGolden(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

Bytes encodeGolden(const GoldenFile& file, DecodedOrder* decoded) {
  EncodeOptions options = file.options;
  options.wantOrder = true;
  MemorySink sink;
  EncodeReport report;
  const std::size_t count = file.xyz.size() / 3;
  const std::vector<float> narrow(file.xyz.begin(), file.xyz.end());
  PointSetView points = file.type == ScalarType::Float32 ? PointSetView(narrow.data(), count)
                                                         : PointSetView(file.xyz.data(), count);
  for (const ArrayValues& array : file.arrays) points.addArray(array.view());
  if (!file.cells.empty()) points.setMesh(&file.cells);
  for (const ArrayValues& array : file.cellArrays) points.addCellArray(array.view());
  report = encode(points, sink, options);
  if (decoded == nullptr) return sink.take();
  decoded->points = report.order;
  decoded->cells = report.cellOrder;
  for (const std::uint64_t i : report.order) {
    for (std::size_t k = 0; k < 3; ++k) decoded->xyz.push_back(file.xyz[3 * i + k]);
    decoded->tuples.push_back(tuplesOf(file.arrays, i));
  }
  for (const std::uint64_t i : report.cellOrder) {
    decoded->cellTuples.push_back(tuplesOf(file.cellArrays, i));
  }
  return sink.take();
}

}  // namespace bspc::test
