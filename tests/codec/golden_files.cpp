#include "codec/golden_files.h"

#include <cstdint>
#include <random>

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

std::vector<double> noise(unsigned count, std::uint64_t range) {
  std::mt19937_64 random(2026);
  std::vector<double> xyz;
  for (unsigned i = 0; i < 3 * count; ++i) xyz.push_back(static_cast<double>(random() % range));
  return xyz;
}

}  // namespace

std::vector<GoldenFile> goldenFiles() {
  std::vector<GoldenFile> files;
  for (const Method method : availableMethods()) {
    const std::string name = methodName(method);
    const auto add = [&](const std::string& what, std::vector<double> xyz, ScalarType type,
                         Layout layout, unsigned layers, const GridRequest& grid) {
      GoldenFile file{std::string(name).append("_").append(what), std::move(xyz), type, {}, {}};
      file.options.method = method;
      file.options.layout = layout;
      file.options.layers = layers;
      file.options.grid = grid;
      files.push_back(std::move(file));
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
    add("empty", {}, ScalarType::Float32, Layout::Progressive, 1, any);
  }
  return files;
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
  report = encode(points, sink, options);
  if (decoded == nullptr) return sink.take();
  for (const std::uint64_t i : report.order) {
    for (std::size_t k = 0; k < 3; ++k) decoded->xyz.push_back(file.xyz[3 * i + k]);
    std::string tuples;
    for (const ArrayValues& array : file.arrays) tuples += tupleOf(array, i);
    decoded->tuples.push_back(std::move(tuples));
  }
  return sink.take();
}

}  // namespace bspc::test
