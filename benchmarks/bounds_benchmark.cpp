// What hostile files can cost: run bounds_benchmark [POINTS]
//
// Sets and meshes that are as bad for the decoder as we know them, of POINTS points (65,536) and of
// a quarter of them, so that what grows faster than its points is seen. A line for each: bytes of
// the file; microseconds of processor time that decoding takes a point (for meshes a cell, for
// arrays a value, all with what their points take) and a byte; milliseconds of processor time
// between two calls of the progress callback, at most, which is how long a wish to stop waits. One
// thread.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/encoder.h"

namespace bspc {
namespace {

using Coordinates = std::vector<std::int32_t>;

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(const std::string& name, const Coordinates& xyz, const MeshCells& cells,
             const EncodeOptions& options, const ArrayValues& array = {}) {
  PointSetView points(xyz.data(), xyz.size() / 3);
  if (!cells.empty()) points.setMesh(&cells);
  if (array.components > 0 && !array.values.empty()) points.addArray(array.view());
  MemorySink sink;
  encode(points, sink, options);
  double longest = 0;
  double last = now();
  const double start = last;
  DecodeOptions decoding;
  decoding.threads = 1;
  decoding.progress = [&](double) {
    const double time = now();
    longest = std::max(longest, time - last);
    last = time;
    return true;
  };
  Decoder(std::make_shared<MemorySource>(sink.bytes())).decode(decoding);
  const double seconds = now() - start;
  std::size_t items = cells.empty() ? points.size() : cells.faces.size();
  if (!array.values.empty()) items *= array.components;
  std::printf("%-34s %9zu %10zu %9.3f %9.3f %7.1f\n", name.c_str(), items, sink.bytes().size(),
              1e6 * seconds / static_cast<double>(items),
              1e6 * seconds / static_cast<double>(sink.bytes().size()), 1e3 * longest);
  std::fflush(stdout);
}

Coordinates randomPoints(std::size_t count, std::int32_t extent) {
  std::mt19937 random(7);
  Coordinates xyz;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    xyz.push_back(static_cast<std::int32_t>(random() % static_cast<unsigned>(extent)));
  }
  return xyz;
}

Coordinates lattice(std::size_t count) {
  const auto side = static_cast<std::size_t>(std::cbrt(static_cast<double>(count)));
  Coordinates xyz;
  for (std::size_t i = 0; i < side * side * side; ++i) {
    for (const std::size_t v : {i % side, i / side % side, i / side / side}) {
      xyz.push_back(static_cast<std::int32_t>(v));
    }
  }
  return xyz;
}

Coordinates sphere(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Coordinates xyz;
  for (std::size_t i = 0; i < count; ++i) {
    const double v[] = {normal(random), normal(random), normal(random)};
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 1e-9;
    for (const double x : v) xyz.push_back(static_cast<std::int32_t>(1e6 + 1e6 * x / length));
  }
  return xyz;
}

void measureSets(std::size_t count) {
  struct Coding {
    const char* name;
    Method method;
    unsigned effort;
  };
  const Coding codings[] = {{"fast 1", Method::Fast, 1},
                            {"fast 4", Method::Fast, 4},
                            {"kd", Method::Kd, 0},
                            {"octree", Method::Octree, 0},
                            {"gencode", Method::GenCode, 0},
                            {"bsp", Method::Bsp, 0},
                            {"predictive 5", Method::Predictive, 5},
                            {"predictive 9", Method::Predictive, 9}};
  for (const Coding& coding : codings) {
    const auto run = [&](const char* what, const Coordinates& xyz, unsigned layers) {
      EncodeOptions options;
      options.method = coding.method;
      if (coding.effort > 0) options.effort = coding.effort;
      options.layers = layers;
      options.tilePoints = count;
      options.threads = 1;
      measure(std::string(coding.name) + ", " + what, xyz, {}, options);
    };
    for (const std::size_t n : {count / 4, count}) {
      run("one place", Coordinates(3 * n, 5), 1);
      run("any places", randomPoints(n, 1 << 21), 1);
      run("any places, 4 layers", randomPoints(n, 1 << 21), 4);
      run("few places", randomPoints(n, 16), 1);
      run("a lattice", lattice(n), 1);
      run("a sphere", sphere(n), 1);
    }
  }
}

using Triangle = std::vector<std::uint32_t>;

void addTriangle(MeshCells& cells, const Triangle& triangle) { cells.faces.add(triangle); }

/// Each triangle of three vertices anywhere, so that nothing near by is of help.
MeshCells randomTriangles(std::size_t points, std::size_t count) {
  std::mt19937 random(8);
  MeshCells cells;
  const auto any = [&] { return static_cast<std::uint32_t>(random() % points); };
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = any();
    const std::uint32_t b = any();
    const std::uint32_t c = any();
    if (a != b && b != c && c != a) addTriangle(cells, {a, b, c});
  }
  return cells;
}

/// Triangles around one vertex.
MeshCells fan(std::size_t points) {
  MeshCells cells;
  for (std::uint32_t i = 1; i + 1 < points; ++i) addTriangle(cells, {0, i, i + 1});
  return cells;
}

MeshCells rows(std::size_t points) {
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(points)));
  MeshCells cells;
  for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
    addTriangle(cells, {i, i + 1, i + side});
    addTriangle(cells, {i + 1, i + side + 1, i + side});
  }
  return cells;
}

void measureMeshes(std::size_t count) {
  struct Coding {
    const char* name;
    Method method;
  };
  for (const Coding& coding : {Coding{"surface", Method::Surface}, Coding{"faces", Method::Kd}}) {
    const auto run = [&](const char* what, const Coordinates& xyz, const MeshCells& cells) {
      EncodeOptions options;
      options.method = coding.method;
      options.layers = 1;
      options.tilePoints = count;
      options.threads = 1;
      measure(std::string(coding.name) + ", " + what, xyz, cells, options);
    };
    for (const std::size_t n : {count / 4, count}) {
      run("rows", randomPoints(n, 1 << 21), rows(n));
      run("one place", Coordinates(3 * n, 5), rows(n));
      run("around one vertex", sphere(n), fan(n));
      run("anywhere on a sphere", sphere(n), randomTriangles(n, n / 4));
    }
  }
}

/// Four values a point, in each way in which they are coded.
void measureArrays(std::size_t count) {
  std::mt19937 random(9);
  for (const ScalarType type : {ScalarType::UInt8, ScalarType::Float64}) {
    for (const bool smooth : {false, true}) {
      ArrayValues array;
      array.name = "values";
      array.type = type;
      array.components = 4;
      for (const std::size_t n : {count / 4, count}) {
        const Coordinates xyz = sphere(n);
        array.values.clear();
        for (std::size_t i = 0; i < 4 * n * scalarSize(type); ++i) {
          const std::int32_t height = xyz[3 * (i / (4 * scalarSize(type)))];
          array.values.push_back(
              static_cast<std::uint8_t>(smooth ? static_cast<unsigned>(height) >> 14 : random()));
        }
        for (const unsigned effort : {1U, 9U}) {
          EncodeOptions options;
          options.effort = effort;
          options.method = Method::Fast;
          if (effort > 4) options.method = Method::Predictive;
          options.layers = 1;
          options.tilePoints = n;
          options.threads = 1;
          measure(std::string(scalarName(type)) + " " + std::to_string(effort) +
                      (smooth ? ", smooth" : ", random"),
                  xyz, {}, options, array);
        }
      }
    }
  }
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  try {
    const long wished = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 65536;
    const auto count = static_cast<std::size_t>(std::clamp(wished, 64L, 1L << 26));
    std::printf("%-34s %9s %10s %9s %9s %7s\n", "", "points", "bytes", "us/point", "us/byte",
                "gap ms");
    bspc::measureSets(count);
    bspc::measureArrays(count / 4);
    bspc::measureMeshes(count / 4);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bounds_benchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
