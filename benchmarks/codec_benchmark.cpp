// Speed of every geometry method on one core, and of the whole way from coordinates to file and
// back. Run: build/release/bin/codec_benchmark

#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "geometry/geometry_method.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

struct Shape {
  const char* name;
  std::vector<GridPoint> points;
};

/// A scan of a million points on 12 and on 20 bits, and noise, for which no coder has a model.
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{
      {"sphere_12bit", test::scannedSphere(1, 1000000, 4095)},
      {"sphere_20bit", test::scannedSphere(2, 1000000, (1U << 20) - 1)},
      {"noise_16bit", test::randomPoints(3, 1000000, {65535, 65535, 65535})},
  };
  return all;
}

geometry::TileInput tileOf(const Shape& shape) {
  geometry::TileInput tile;
  tile.points = shape.points;
  for (const GridPoint& p : shape.points) {
    for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = std::max(tile.extent[k], p[k]);
  }
  return tile;
}

void report(benchmark::State& state, std::size_t points, std::size_t bytes) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points));
  state.counters["bits/point"] = 8.0 * static_cast<double>(bytes) / static_cast<double>(points);
}

std::size_t payload(const geometry::EncodedTile& coded) {
  std::size_t bytes = 0;
  for (const Bytes& layer : coded.layers) bytes += layer.size();
  return bytes;
}

void encodeGeometry(benchmark::State& state, Method id, const Shape& shape) {
  const geometry::GeometryMethod& method = *geometry::findGeometryMethod(id);
  const geometry::TileInput tile = tileOf(shape);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = payload(method.encode(tile, {}));
  report(state, shape.points.size(), bytes);
}

void decodeGeometry(benchmark::State& state, Method id, const Shape& shape) {
  const geometry::GeometryMethod& method = *geometry::findGeometryMethod(id);
  const geometry::TileInput tile = tileOf(shape);
  const geometry::EncodedTile coded = method.encode(tile, {});
  geometry::TileToDecode input;
  input.points = shape.points.size();
  input.extent = tile.extent;
  input.payloads.emplace_back(coded.layers[0]);
  input.maxPoints = input.maxBytes = std::numeric_limits<std::uint64_t>::max();
  input.maxDepth = 512;
  for (auto _ : state) benchmark::DoNotOptimize(method.decode(input, {}));
  report(state, shape.points.size(), payload(coded));
}

std::vector<float> coordinates(const Shape& shape) {
  std::vector<float> xyz;
  for (const GridPoint& p : shape.points) {
    for (const std::uint32_t v : p) xyz.push_back(static_cast<float>(v));
  }
  return xyz;
}

void encodeFile(benchmark::State& state, Method id, const Shape& shape) {
  const std::vector<float> xyz = coordinates(shape);
  EncodeOptions options;
  options.method = id;
  std::size_t bytes = 0;
  for (auto _ : state) {
    MemorySink sink;
    encode(PointSetView(xyz.data(), shape.points.size()), sink, options);
    bytes = sink.bytes().size();
  }
  report(state, shape.points.size(), bytes);
}

void decodeFile(benchmark::State& state, Method id, const Shape& shape) {
  const std::vector<float> xyz = coordinates(shape);
  EncodeOptions options;
  options.method = id;
  MemorySink sink;
  encode(PointSetView(xyz.data(), shape.points.size()), sink, options);
  std::vector<float> back(xyz.size());
  for (auto _ : state) {
    Decoder decoder(std::make_shared<MemorySource>(sink.bytes()));
    const DecodedPoints points = decoder.decode();
    restorePositions(decoder.info().grid, Span<const GridPoint>(points.points), back.data());
  }
  report(state, shape.points.size(), sink.bytes().size());
}

void registerAll() {
  using Run = void (*)(benchmark::State&, Method, const Shape&);
  const std::pair<const char*, Run> runs[] = {{"geometry/encode", encodeGeometry},
                                              {"geometry/decode", decodeGeometry},
                                              {"file/encode", encodeFile},
                                              {"file/decode", decodeFile}};
  for (const Method id : availableMethods()) {
    for (const Shape& shape : shapes()) {
      for (const auto& [what, run] : runs) {
        const std::string name = std::string(methodName(id)) + '/' + what + '/' + shape.name;
        benchmark::RegisterBenchmark(name.c_str(), run, id, shape)->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  bspc::registerAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
