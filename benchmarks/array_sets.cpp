#include "array_sets.h"

#include <lzf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <stdexcept>

namespace bspc::benchmarks {

namespace {

using Vector = std::array<double, 3>;

template <class T>
T load(const Bytes& bytes, std::size_t at) {
  if (at + sizeof(T) > bytes.size()) throw std::runtime_error("the file ends early");
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <class T>
void append(attributes::ArrayValues& values, T value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  values.numbers.insert(values.numbers.end(), first, first + sizeof value);
}

/// Puts whole numbers on a grid that starts at the least of each axis.
std::vector<GridPoint> onGrid(const std::vector<std::array<std::int64_t, 3>>& positions) {
  std::array<std::int64_t, 3> least = positions.at(0);
  for (const auto& p : positions) {
    for (std::size_t k = 0; k < 3; ++k) least[k] = std::min(least[k], p[k]);
  }
  std::vector<GridPoint> points;
  for (const auto& p : positions) {
    GridPoint point{};
    for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<std::uint32_t>(p[k] - least[k]);
    points.push_back(point);
  }
  return points;
}

NamedArray named(const std::string& name, ScalarType type, std::uint32_t components = 1,
                 Semantic semantic = Semantic::None) {
  return {name, {type, components, semantic}, {}};
}

ArraySet readLas(const Bytes& bytes) {
  constexpr std::size_t kRecord = 34;
  if ((load<std::uint8_t>(bytes, 104) & 0x3F) != 3 || load<std::uint16_t>(bytes, 105) != kRecord) {
    throw std::runtime_error("only LAS files of point format 3 are read");
  }
  const auto first = load<std::uint32_t>(bytes, 96);
  const auto count = load<std::uint32_t>(bytes, 107);
  std::vector<std::array<std::int64_t, 3>> positions;
  ArraySet set;
  set.arrays = {named("rgb", ScalarType::UInt16, 3, Semantic::Colours),
                named("intensity", ScalarType::UInt16),
                named("return bits", ScalarType::UInt8),
                named("classification", ScalarType::UInt8),
                named("scan angle", ScalarType::Int8),
                named("user data", ScalarType::UInt8),
                named("source id", ScalarType::UInt16),
                named("gps time", ScalarType::Float64)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = first + i * kRecord;
    positions.push_back({load<std::int32_t>(bytes, at), load<std::int32_t>(bytes, at + 4),
                         load<std::int32_t>(bytes, at + 8)});
    for (std::size_t c = 0; c < 3; ++c) {
      append(set.arrays[0].values, load<std::uint16_t>(bytes, at + 28 + 2 * c));
    }
    append(set.arrays[1].values, load<std::uint16_t>(bytes, at + 12));
    append(set.arrays[2].values, load<std::uint8_t>(bytes, at + 14));
    append(set.arrays[3].values, load<std::uint8_t>(bytes, at + 15));
    append(set.arrays[4].values, load<std::int8_t>(bytes, at + 16));
    append(set.arrays[5].values, load<std::uint8_t>(bytes, at + 17));
    append(set.arrays[6].values, load<std::uint16_t>(bytes, at + 18));
    append(set.arrays[7].values, load<double>(bytes, at + 20));
  }
  set.points = onGrid(positions);
  return set;
}

ArraySet readPcd(const Bytes& bytes) {
  const std::string text(
      bytes.begin(),
      bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 512)));
  const std::string mark = "DATA binary_compressed\n";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos || text.find("FIELDS x y z rgb\n") == std::string::npos) {
    throw std::runtime_error("only compressed PCD files of x y z rgb are read");
  }
  const std::size_t start = at + mark.size();
  const auto packed = load<std::uint32_t>(bytes, start);
  Bytes columns(load<std::uint32_t>(bytes, start + 4));
  if (start + 8 + packed > bytes.size() ||
      lzf_decompress(bytes.data() + start + 8, packed, columns.data(),
                     static_cast<unsigned>(columns.size())) != columns.size()) {
    throw std::runtime_error("the PCD file is damaged");
  }
  constexpr std::size_t kRecord = 16;
  const std::size_t count = columns.size() / kRecord;
  std::vector<std::array<std::int64_t, 3>> positions;
  ArraySet set;
  set.arrays = {named("rgb", ScalarType::UInt8, 3, Semantic::Colours)};
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = load<float>(columns, (k * count + i) * 4);
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    constexpr double kMillimetres = 1000;
    positions.push_back({std::llround(p[0] * kMillimetres), std::llround(p[1] * kMillimetres),
                         std::llround(p[2] * kMillimetres)});
    const auto rgb = load<std::uint32_t>(columns, (3 * count + i) * 4);
    for (unsigned c = 0; c < 3; ++c) {
      append(set.arrays[0].values, static_cast<std::uint8_t>(rgb >> (16 - 8 * c)));
    }
  }
  set.points = onGrid(positions);
  return set;
}

struct Mesh {
  std::vector<Vector> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;
};

Mesh parseObj(const Bytes& bytes) {
  Mesh mesh;
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vector v{};
      words >> v[0] >> v[1] >> v[2];
      mesh.vertices.push_back(v);
    } else if (word == "f") {
      std::vector<std::size_t> corners;
      while (words >> word) corners.push_back(std::stoul(word) - 1);
      for (std::size_t k = 2; k < corners.size(); ++k) {
        mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
      }
    }
  }
  return mesh;
}

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
void add(Vector& to, const Vector& v) {
  for (std::size_t k = 0; k < 3; ++k) to[k] += v[k];
}

/// Normals weighted by area, and the steps to the mean of the neighbours along edges.
void describe(const Mesh& mesh, std::vector<Vector>& normals, std::vector<Vector>& laplacians) {
  normals.assign(mesh.vertices.size(), Vector{});
  laplacians.assign(mesh.vertices.size(), Vector{});
  std::vector<double> edges(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Vector normal = cross(minus(mesh.vertices.at(t[1]), mesh.vertices.at(t[0])),
                                minus(mesh.vertices.at(t[2]), mesh.vertices.at(t[0])));
    for (std::size_t k = 0; k < 3; ++k) {
      add(normals[t[k]], normal);
      add(laplacians[t[k]], minus(mesh.vertices[t[(k + 1) % 3]], mesh.vertices[t[k]]));
      edges[t[k]] += 1;
    }
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = std::sqrt(dot(normals[i], normals[i]));
    for (std::size_t k = 0; k < 3; ++k) {
      normals[i][k] = length > 0 ? normals[i][k] / length : 0;
      laplacians[i][k] = edges[i] > 0 ? laplacians[i][k] / edges[i] : 0;
    }
  }
}

ArraySet readObj(const Bytes& bytes) {
  constexpr double kLast = 4095;
  const Mesh mesh = parseObj(bytes);
  std::vector<Vector> normals;
  std::vector<Vector> laplacians;
  describe(mesh, normals, laplacians);
  Vector lower = mesh.vertices.at(0);
  Vector upper = lower;
  for (const Vector& v : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], v[k]);
      upper[k] = std::max(upper[k], v[k]);
    }
  }
  const Vector size = minus(upper, lower);
  const double extent = std::max({size[0], size[1], size[2]});
  ArraySet set;
  set.arrays = {named("normals", ScalarType::Float32, 3, Semantic::Normals),
                named("smooth float32", ScalarType::Float32),
                named("smooth float64", ScalarType::Float64),
                named("curvature", ScalarType::Float32), named("random int32", ScalarType::Int32)};
  std::vector<std::array<std::int64_t, 3>> positions;
  std::mt19937 random(1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vector u = minus(mesh.vertices[i], lower);
    for (double& x : u) x /= extent;
    positions.push_back(
        {std::llround(u[0] * kLast), std::llround(u[1] * kLast), std::llround(u[2] * kLast)});
    for (const double x : normals[i]) append(set.arrays[0].values, static_cast<float>(x));
    const double smooth = std::sin(3 * u[0]) * std::cos(2 * u[1]) + 0.5 * u[2] * u[2];
    append(set.arrays[1].values, static_cast<float>(smooth));
    append(set.arrays[2].values, smooth);
    append(set.arrays[3].values, static_cast<float>(dot(laplacians[i], normals[i]) / extent));
    append(set.arrays[4].values, static_cast<std::int32_t>(random()));
  }
  set.points = onGrid(positions);
  return set;
}

}  // namespace

ArraySet readArraySet(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot be opened");
  const Bytes bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  ArraySet set;
  if (ending == ".las") {
    set = readLas(bytes);
  } else if (ending == ".pcd") {
    set = readPcd(bytes);
  } else if (ending == ".obj") {
    set = readObj(bytes);
  } else {
    throw std::runtime_error("only .las, .pcd and .obj files are read");
  }
  set.name = path.substr(path.find_last_of('/') + 1);
  return set;
}

}  // namespace bspc::benchmarks
