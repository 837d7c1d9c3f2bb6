// What the efforts cost and give, and what each idea of method predictive is worth, on given
// models.
//
//   efforts_benchmark table [--repeat N] FILE.ply...
//   efforts_benchmark ablation [--effort E] FILE.ply...
//
// `table` prints tab-separated lines: model, points, effort, bits a point of the whole file in one
// layer, and microseconds a point of processor time on one thread to encode and to decode; medians
// of runs in which the efforts take turns. Every file is decoded and compared. `ablation` prints
// for each feature of an effort how many bits a point the models' payloads take without it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark_support.h"
#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "geometry/predictive/efforts.h"
#include "geometry/predictive/predictive_method.h"

namespace bspc {
namespace {

constexpr unsigned kEfforts[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};

struct Runs {
  Bytes bytes;
  std::vector<double> encodeSeconds;
  std::vector<double> decodeSeconds;
};

void runOnce(const Coordinates& xyz, unsigned effort, Runs& runs) {
  EncodeOptions options;
  options.effort = effort;
  options.layers = 1;
  options.threads = 1;
  runs.encodeSeconds.push_back(secondsOf([&] {
    MemorySink sink;
    encode(PointSetView(xyz.data(), xyz.size() / 3), sink, options);
    runs.bytes = sink.bytes();
  }));
  Coordinates back;
  runs.decodeSeconds.push_back(secondsOf([&] {
    Decoder decoder(std::make_shared<MemorySource>(runs.bytes));
    DecodeOptions decoding;
    decoding.threads = 1;
    const DecodedPoints decoded = decoder.decode(decoding);
    back.resize(3 * decoded.points.size());
    restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  }));
  if (runs.decodeSeconds.size() == 1 && sortedPoints(back) != sortedPoints(xyz)) {
    throw std::runtime_error("effort " + std::to_string(effort) + " did not give the points back");
  }
}

void printTable(const std::string& path, int repetitions) {
  const Coordinates xyz = readOnLattice(path);
  const auto points = static_cast<double>(xyz.size() / 3);
  std::vector<Runs> runs(std::size(kEfforts));
  for (int i = 0; i < repetitions; ++i) {
    for (std::size_t e = 0; e < runs.size(); ++e) runOnce(xyz, kEfforts[e], runs[e]);
  }
  for (std::size_t e = 0; e < runs.size(); ++e) {
    std::printf("%s\t%.0f\t%u\t%.3f\t%.3f\t%.3f\n", modelName(path).c_str(), points, kEfforts[e],
                8 * static_cast<double>(runs[e].bytes.size()) / points,
                median(runs[e].encodeSeconds) / points * 1e6,
                median(runs[e].decodeSeconds) / points * 1e6);
  }
  std::fflush(stdout);
}

using geometry::predictive::Features;

struct Removal {
  const char* name;
  std::uint32_t flags;
  bool pairs = false;      ///< of near points: without them there are no candidates
  bool flatBoxes = false;  ///< efforts 5 and 9 have none
};

constexpr Removal kRemovals[] = {
    {"mirror planes", Features::kMirror},
    {"all candidates", 0, true},
    {"candidates a + b - c", Features::kParallelograms},
    {"candidates on the quadric", Features::kProjection},
    {"candidates kept apart", Features::kSeparateKinds},
    {"candidates at two widths", Features::kTwoScales},
    {"quadric", Features::kQuadric | Features::kNarrowQuadric | Features::kProjection},
    {"quadric once more, narrower", Features::kNarrowQuadric},
    {"plane beside the quadric", Features::kPlane},
    {"lattices of axes", Features::kPhase},
    {"axis values", Features::kAxisValues},
    {"range images", Features::kRangeImage},
    {"coordinates once more, wider", Features::kWideCoordinates},
    {"density", Features::kDensity},
    {"distance to the nearest point", Features::kNearest},
    {"more contexts", Features::kManyContexts},
    {"mixing in two layers", Features::kTwoLayers},
    {"near points a cell farther off", Features::kFartherPoints},
    {"rows of three that bend", Features::kChains},
    {"flat boxes", 0, false, true},
    {"lone points axis by axis", Features::kResiduals},
};

/// Bits a point of a model's payload.
double bitsWith(const Coordinates& xyz, const Features& features) {
  std::vector<GridPoint> points(xyz.size() / 3);
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    points[i / 3][i % 3] = static_cast<std::uint32_t>(xyz[i]);
  }
  geometry::TileInput tile;
  tile.points = points;
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = std::max(tile.extent[k], p[k]);
  }
  tile.wishes.features = &features;
  const geometry::EncodedTile coded = geometry::PredictiveMethod().encode(tile, {});
  return 8 * static_cast<double>(coded.layers[0].size()) / static_cast<double>(points.size());
}

void printAblation(const std::vector<std::string>& paths, unsigned effort) {
  std::vector<Coordinates> models;
  std::printf("removed");
  for (const std::string& path : paths) {
    models.push_back(readOnLattice(path));
    std::printf("\t%s", modelName(path).c_str());
  }
  std::printf("\tmean loss\n");
  const Features all = geometry::predictive::featuresOf(effort);
  std::vector<double> base;
  std::printf("nothing");
  for (const Coordinates& xyz : models) {
    base.push_back(bitsWith(xyz, all));
    std::printf("\t%.3f", base.back());
    std::fflush(stdout);
  }
  std::printf("\t\n");
  for (const Removal& removal : kRemovals) {
    Features features = all;
    features.flags &= ~removal.flags;
    if (removal.pairs) features.pairReach = 0;
    if (removal.flatBoxes) features.flatShare = 0;
    double loss = 0;
    std::printf("%s", removal.name);
    for (std::size_t m = 0; m < models.size(); ++m) {
      const double bits = bitsWith(models[m], features);
      loss += bits - base[m];
      std::printf("\t%.3f", bits);
      std::fflush(stdout);
    }
    std::printf("\t%.3f\n", loss / static_cast<double>(models.size()));
  }
}

int usage() {
  std::fputs(
      "Usage: efforts_benchmark table [--repeat N] FILE.ply...\n"
      "       efforts_benchmark ablation [--effort 5..9] FILE.ply...\n",
      stderr);
  return 2;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return usage();
  const bool table = arguments[0] == "table";
  if (!table && arguments[0] != "ablation") return usage();
  long number = table ? 3 : geometry::predictive::kMostEffort;
  std::size_t first = 1;
  if (arguments.size() > 2 && arguments[1] == (table ? "--repeat" : "--effort")) {
    number = std::strtol(arguments[2].c_str(), nullptr, 10);
    first = 3;
  }
  const bool valid = table ? number > 0
                           : number >= long{geometry::predictive::kLeastEffort} &&
                                 number <= long{geometry::predictive::kMostEffort};
  if (first >= arguments.size() || !valid) return usage();
  const std::vector<std::string> paths(arguments.begin() + static_cast<std::ptrdiff_t>(first),
                                       arguments.end());
  if (!table) {
    printAblation(paths, static_cast<unsigned>(number));
    return 0;
  }
  std::printf("model\tpoints\teffort\tbpp\tencode us\tdecode us\n");
  for (const std::string& path : paths) printTable(path, static_cast<int>(number));
  return 0;
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  try {
    return bspc::run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "efforts_benchmark: %s\n", error.what());
    return 1;
  }
}
