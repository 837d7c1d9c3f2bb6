// What reading into vtkPolyData costs beside the library's own decoding, in one process on one core
// and on all. Run: vtk_read_benchmark [--repeat N] [POINTS]
//
// The library decodes all tiles and restores the positions into one array; vtkBSPReader makes
// vtkPoints, one vertex cell a point and arrays. Both read the same bytes in memory. Runs
// alternate, so that a busy spell of the machine meets both, and each time is the median of N
// (default 9).

#include <vtkBSPReader.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

/// A scan in float64 coordinates on a millimetre lattice, with or without arrays.
Bytes encodedScan(std::size_t count, bool arrays) {
  const std::vector<GridPoint> points = test::scannedSphere(17, count, 65535);
  std::vector<double> xyz;
  std::vector<std::uint8_t> rgb;
  std::vector<float> normals;
  for (const GridPoint& p : points) {
    double length = 0;
    for (const std::uint32_t v : p) {
      xyz.push_back(500000 + v * 0.001);
      length += (v - 32768.0) * (v - 32768.0);
    }
    for (const std::uint32_t v : p) {
      normals.push_back(static_cast<float>((v - 32768.0) / std::sqrt(length)));
      rgb.push_back(static_cast<std::uint8_t>(128 + 100 * normals.back()));
    }
  }
  PointSetView view(xyz.data(), count);
  if (arrays) {
    ArrayView colours;
    colours.name = "RGB";
    colours.type = ScalarType::UInt8;
    colours.components = 3;
    colours.semantic = Semantic::Colours;
    colours.tuples = count;
    colours.data = rgb.data();
    view.addArray(colours);
    ArrayView directions = colours;
    directions.name = "Normals";
    directions.type = ScalarType::Float32;
    directions.semantic = Semantic::Normals;
    directions.data = normals.data();
    view.addArray(directions);
  }
  MemorySink sink;
  encode(view, sink);
  return sink.take();
}

struct Times {
  std::vector<double> wall;
  std::vector<double> processor;

  void measure(const std::function<void()>& call) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t before = std::clock();
    call();
    processor.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void decodeWithTheLibrary(const Bytes& bytes, unsigned threads) {
  Decoder decoder(std::make_shared<MemorySource>(bytes));
  DecodeOptions options;
  options.threads = threads;
  const DecodedPoints decoded = decoder.decode(options);
  std::vector<double> xyz(3 * decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), xyz.data());
}

void compare(const std::string& name, const Bytes& bytes, unsigned threads, int repetitions) {
  const std::string text(bytes.begin(), bytes.end());
  Times library;
  Times reading;
  for (int i = 0; i < repetitions; ++i) {
    library.measure([&] { decodeWithTheLibrary(bytes, threads); });
    vtkNew<vtkBSPReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(text);
    reader->SetNumberOfThreads(static_cast<int>(threads));
    reading.measure([&] { reader->Update(); });
  }
  std::printf("%-16s %8s %11.1f %11.1f %7.2f %11.1f %11.1f %7.2f\n", name.c_str(),
              threads == 0 ? "all" : std::to_string(threads).c_str(), 1e3 * median(library.wall),
              1e3 * median(reading.wall), median(reading.wall) / median(library.wall),
              1e3 * median(library.processor), 1e3 * median(reading.processor),
              median(reading.processor) / median(library.processor));
  std::fflush(stdout);
}

int runAll(int count, char** arguments) {
  int repetitions = 9;
  std::size_t points = 1000000;
  for (int i = 1; i < count; ++i) {
    if (std::string(arguments[i]) == "--repeat" && i + 1 < count) {
      repetitions = static_cast<int>(std::strtol(arguments[++i], nullptr, 10));
    } else {
      points = std::strtoull(arguments[i], nullptr, 10);
    }
  }
  if (repetitions < 1 || points < 1) {
    std::fputs("Usage: vtk_read_benchmark [--repeat N] [POINTS]\n", stderr);
    return 2;
  }
  std::printf("%zu points; milliseconds, medians of %d\n\n", points, repetitions);
  std::printf("%-16s %8s %11s %11s %7s %11s %11s %7s\n", "", "", "library", "reader", "", "library",
              "reader", "");
  std::printf("%-16s %8s %11s %11s %7s %11s %11s %7s\n", "file", "threads", "wall", "wall", "ratio",
              "processor", "processor", "ratio");
  for (const bool arrays : {false, true}) {
    const Bytes bytes = encodedScan(points, arrays);
    for (const unsigned threads : {1U, 0U}) {
      compare(arrays ? "RGB, normals" : "positions", bytes, threads, repetitions);
    }
  }
  return 0;
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) { return bspc::runAll(argc, argv); }
