// Sizes and speeds of bspc beside those of Draco's kd-tree coder for point clouds, in one process
// on one core. Run: draco_benchmark [--repeat N] [--coder NAME]... FILE.ply...
//
// Both coders get the same whole numbers, and both must give all of them back: a model that lies
// on no lattice is left out. Draco's coder takes integers as they are, so no quantisation comes
// between. bspc writes one layer, since Draco has no levels of detail; sizes are of whole files,
// times of everything between coordinates and bytes in memory. They are processor times, which
// other processes disturb least; runs of the coders alternate, so that a busy spell of the machine
// meets all of them, and each time is the median. Speeds are told relative to Draco's smallest
// files, too. With --coder only the first and those with that in their name run.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_support.h"
#include "bspc/encoder.h"
#include "codec.h"

namespace bspc {
namespace {

std::vector<bench::Codec> allCoders() {
  std::vector<bench::Codec> coders;
  for (const int speed : {0, 10}) {
    coders.push_back(bench::dracoCodec(bench::DracoMethod::KdTree, speed));
  }
  EncodeOptions options;
  options.layers = 1;
  options.method = Method::Kd;
  coders.push_back(bench::bspcCodec("bspc kd", options));
  options.method = Method::Fast;
  for (const unsigned effort : {1U, 2U, 3U, 4U}) {
    options.effort = effort;
    coders.push_back(bench::bspcCodec("bspc fast effort " + std::to_string(effort), options));
  }
  return coders;
}

/// All coders, or the first and those whose names have a part of `wanted`.
std::vector<bench::Codec> codersNamed(const std::vector<std::string>& wanted) {
  std::vector<bench::Codec> coders;
  for (bench::Codec& coder : allCoders()) {
    const bool named = std::any_of(wanted.begin(), wanted.end(), [&coder](const std::string& part) {
      return coder.name.find(part) != std::string::npos;
    });
    if (coders.empty() || wanted.empty() || named) coders.push_back(std::move(coder));
  }
  return coders;
}

struct Measurement {
  std::size_t bytes = 0;
  std::vector<double> encodeSeconds;
  std::vector<double> decodeSeconds;
};

/// One run of a coder; the first checks what comes back.
void runOnce(const bench::Codec& coder, const Coordinates& xyz, Measurement& result) {
  Bytes bytes;
  Coordinates back;
  result.encodeSeconds.push_back(secondsOf([&] { bytes = coder.encode(xyz, 1); }));
  result.decodeSeconds.push_back(secondsOf([&] { back = coder.decode(bytes, 1); }));
  if (result.bytes == 0 && sortedPoints(back) != sortedPoints(xyz)) {
    throw std::runtime_error(coder.name + " did not give the points back");
  }
  result.bytes = bytes.size();
}

void printHead() {
  std::printf("%-24s %10s  %-24s %8s %12s %12s  %s\n", "file", "points", "coder", "bpp",
              "enc Mpts/s", "dec Mpts/s", "size, enc, dec / draco 0");
}

void compare(const std::string& path, const std::vector<bench::Codec>& coders, int repetitions) {
  const Coordinates xyz = readOnLattice(path);
  const std::size_t count = xyz.size() / 3;
  const auto points = static_cast<double>(count);
  std::vector<Measurement> results(coders.size());
  for (int i = 0; i < repetitions; ++i) {
    for (std::size_t c = 0; c < coders.size(); ++c) runOnce(coders[c], xyz, results[c]);
  }
  const std::string name = modelName(path);
  for (std::size_t c = 0; c < coders.size(); ++c) {
    const Measurement& result = results[c];
    const double encodeSeconds = median(result.encodeSeconds);
    const double decodeSeconds = median(result.decodeSeconds);
    std::printf("%-24s %10.0f  %-24s %8.3f %12.2f %12.2f  %.3f %.2f %.2f\n", name.c_str(), points,
                coders[c].name.c_str(), 8 * static_cast<double>(result.bytes) / points,
                points / encodeSeconds / 1e6, points / decodeSeconds / 1e6,
                static_cast<double>(result.bytes) / static_cast<double>(results[0].bytes),
                median(results[0].encodeSeconds) / encodeSeconds,
                median(results[0].decodeSeconds) / decodeSeconds);
  }
  std::fflush(stdout);
}

int usage() {
  std::fputs("Usage: draco_benchmark [--repeat N] [--coder NAME]... FILE.ply...\n", stderr);
  return 2;
}

int runAll(int count, char** arguments) {
  int repetitions = 7;
  std::vector<std::string> wanted;
  int first = 1;
  for (; first + 1 < count; first += 2) {
    const std::string option = arguments[first];
    if (option == "--repeat") {
      repetitions = static_cast<int>(std::strtol(arguments[first + 1], nullptr, 10));
    } else if (option == "--coder") {
      wanted.emplace_back(arguments[first + 1]);
    } else {
      break;
    }
  }
  if (first >= count || repetitions < 1) return usage();
  const std::vector<bench::Codec> coders = codersNamed(wanted);
  int failures = 0;
  printHead();
  for (int i = first; i < count; ++i) {
    try {
      compare(arguments[i], coders, repetitions);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", arguments[i], error.what());
      ++failures;
    }
  }
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) { return bspc::runAll(argc, argv); }
