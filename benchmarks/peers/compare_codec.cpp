// One step of benchmarks/compare.py, in a process of its own, so that its memory can be told.
//
//   compare_codec list
//   compare_codec kinds
//   compare_codec generate KIND COUNT POINTS
//   compare_codec read MODEL BITS POINTS
//   compare_codec export POINTS MODEL
//   compare_codec same POINTS MODEL
//   compare_codec encode CODEC THREADS SECONDS POINTS FILE
//   compare_codec decode CODEC THREADS SECONDS FILE POINTS|-
//   compare_codec run COMMAND
//
// POINTS is a file of three int32 a point. `encode` and `decode` work from memory to memory, again
// and again until SECONDS are over, and print the medians; `decode` compares what came back with
// POINTS after it has measured. `run` measures one run of a command of the shell. What they print
// is one line of name=value.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark_support.h"
#include "codec.h"
#include "formats/model_io.h"
#include "generated_sets.h"

namespace bspc::bench {
namespace {

using Words = std::vector<std::string>;

std::vector<Codec> allCodecs() {
  constexpr unsigned kMostEffort = 9;
  constexpr int kMostSpeed = 10;
  std::vector<Codec> codecs;
  for (unsigned effort = 1; effort <= kMostEffort; ++effort) {
    EncodeOptions options;
    options.effort = effort;
    codecs.push_back(bspcCodec("bspc effort " + std::to_string(effort), options));
  }
  for (const DracoMethod method : {DracoMethod::KdTree, DracoMethod::Sequential}) {
    for (int speed = 0; speed <= kMostSpeed; ++speed) codecs.push_back(dracoCodec(method, speed));
  }
  for (Codec& codec : vtpCodecs()) codecs.push_back(std::move(codec));
  for (Codec& codec : generalCodecs()) codecs.push_back(std::move(codec));
  return codecs;
}

Codec codecNamed(const std::string& name) {
  for (Codec& codec : allCodecs()) {
    if (codec.name == name) return std::move(codec);
  }
  throw std::runtime_error("there is no codec called " + name);
}

template <class T>
std::vector<T> readAll(const std::string& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw std::runtime_error(path + ": cannot be opened");
  std::vector<T> values(static_cast<std::size_t>(in.tellg()) / sizeof(T));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(values.data()),
          static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!in) throw std::runtime_error(path + ": cannot be read");
  return values;
}

template <class T>
void writeAll(const std::string& path, const std::vector<T>& values) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

/// Bits that the largest coordinate takes.
int bitsOf(const Coordinates& xyz) {
  const auto largest = std::max_element(xyz.begin(), xyz.end());
  int bits = 0;
  while (largest != xyz.end() && bits < 31 && *largest >> bits != 0) ++bits;
  return bits;
}

void writePoints(const std::string& path, const Coordinates& xyz) {
  writeAll(path, xyz);
  std::printf("points=%zu bits=%d\n", xyz.size() / 3, bitsOf(xyz));
}

/// The points of a model on their lattice, or on a grid of so many bits if they lie on none or on
/// one of more than 24 bits.
Coordinates readModelPoints(const std::string& path, unsigned bits) {
  constexpr int kMostBits = 24;
  std::ifstream in(path, std::ios::binary);
  const auto format = formats::formatFromPath(path);
  if (!in || !format) throw std::runtime_error(path + ": cannot be read");
  const formats::Model model = formats::readModel(in, *format);
  const auto onGrid = [&](const GridRequest& request) {
    const GridFit fit = fitGrid(model.view(), request);
    Coordinates xyz;
    xyz.reserve(3 * fit.points.size());
    for (const GridPoint& p : fit.points) {
      for (const std::uint32_t c : p) xyz.push_back(static_cast<std::int32_t>(c & INT32_MAX));
    }
    const bool fits = std::all_of(fit.points.begin(), fit.points.end(), [](const GridPoint& p) {
      return std::max({p[0], p[1], p[2]}) >> kMostBits == 0;
    });
    if (!fit.exact || !fits) xyz.clear();
    return xyz;
  };
  GridRequest lattice = GridRequest::automatic();
  lattice.knownLattice = model.lattice;
  lattice.dropNonFinite = true;
  Coordinates xyz = onGrid(lattice);
  if (!xyz.empty()) return xyz;
  GridRequest quantised = GridRequest::withBits(bits);
  quantised.dropNonFinite = true;
  for (const GridPoint& p : fitGrid(model.view(), quantised).points) {
    for (const std::uint32_t c : p) xyz.push_back(static_cast<std::int32_t>(c));
  }
  if (xyz.empty()) throw std::runtime_error(path + ": has no points");
  return xyz;
}

void exportModel(const Coordinates& xyz, const std::string& path) {
  const auto format = formats::formatFromPath(path);
  if (!format) throw std::runtime_error(path + ": the ending tells no format");
  const std::vector<float> floats(xyz.begin(), xyz.end());
  std::ofstream out(path, std::ios::binary);
  formats::writeModel(out, *format, PointSetView(floats.data(), floats.size() / 3));
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

void checkSame(const Coordinates& given, const Coordinates& back) {
  if (sortedPoints(given) != sortedPoints(back)) {
    throw std::runtime_error("other points came back");
  }
}

void checkModel(const Coordinates& given, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const auto format = formats::formatFromPath(path);
  if (!in || !format) throw std::runtime_error(path + ": cannot be read");
  const formats::Model model = formats::readModel(in, *format);
  const PointSetView view = model.view();
  Coordinates back;
  for (std::uint64_t i = 0; i < view.size(); ++i) {
    for (const double c : view.position(i)) {
      back.push_back(static_cast<std::int32_t>(std::lround(c)));
    }
  }
  checkSame(given, back);
}

/// Most memory that this process has had, in KiB. What getrusage() tells begins with that of the
/// process which started it.
long peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long kib = 0;
    if (word == "VmHWM:" && status >> kib) return kib;
  }
  throw std::runtime_error("the system does not tell how much memory was used");
}

/// Calls again and again, prints medians of time that passed and of processor time.
template <class Call>
void measure(double seconds, std::size_t& bytes, const Call& call) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> elapsed;
  std::vector<double> processor;
  const Clock::time_point start = Clock::now();
  std::chrono::duration<double> total{};
  do {
    const Clock::time_point before = Clock::now();
    processor.push_back(secondsOf(call));
    elapsed.push_back(std::chrono::duration<double>(Clock::now() - before).count());
    total = Clock::now() - start;
  } while (total.count() < seconds);
  std::printf("runs=%zu seconds=%.9f processor=%.9f memory=%ld bytes=%zu\n", elapsed.size(),
              median(elapsed), median(processor), peakMemory(), bytes);
}

void encodeOnce(const Words& words) {
  const Codec codec = codecNamed(words[1]);
  const auto threads = static_cast<unsigned>(std::stoul(words[2]));
  const Coordinates xyz = readAll<std::int32_t>(words[4]);
  Bytes bytes;
  std::size_t size = 0;
  measure(std::stod(words[3]), size, [&] {
    bytes.clear();
    bytes = codec.encode(xyz, threads);
    size = bytes.size();
  });
  writeAll(words[5], bytes);
}

void decodeOnce(const Words& words) {
  const Codec codec = codecNamed(words[1]);
  const auto threads = static_cast<unsigned>(std::stoul(words[2]));
  const Bytes bytes = readAll<std::uint8_t>(words[4]);
  Coordinates xyz;
  std::size_t size = bytes.size();
  measure(std::stod(words[3]), size, [&] {
    xyz = Coordinates();
    xyz = codec.decode(bytes, threads);
  });
  if (words[5] != "-") checkSame(readAll<std::int32_t>(words[5]), xyz);
}

void runCommand(const std::string& command) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process could be started");
  if (child == 0) {
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  if (::wait4(child, &status, 0, &usage) != child) throw std::runtime_error("no child to wait for");
  const std::chrono::duration<double> elapsed = Clock::now() - start;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("failed: " + command);
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  std::printf("runs=1 seconds=%.6f processor=%.6f memory=%ld bytes=0\n", elapsed.count(),
              seconds(usage.ru_utime) + seconds(usage.ru_stime), usage.ru_maxrss);
}

void printCodecs() {
  for (const Codec& codec : allCodecs()) {
    std::printf("%s\t%s\n", codec.name.c_str(), codec.usesThreads ? "threads" : "one thread");
  }
}

int run(const Words& words) {
  const std::string what = words.empty() ? "" : words[0];
  const std::size_t count = words.size();
  if (what == "list" && count == 1) {
    printCodecs();
  } else if (what == "kinds" && count == 1) {
    for (const std::string& kind : generatedKinds()) std::puts(kind.c_str());
  } else if (what == "generate" && count == 4) {
    writePoints(words[3], generatedPoints(words[1], std::stoull(words[2])));
  } else if (what == "read" && count == 4) {
    writePoints(words[3], readModelPoints(words[1], static_cast<unsigned>(std::stoul(words[2]))));
  } else if (what == "export" && count == 3) {
    exportModel(readAll<std::int32_t>(words[1]), words[2]);
  } else if (what == "same" && count == 3) {
    checkModel(readAll<std::int32_t>(words[1]), words[2]);
  } else if (what == "encode" && count == 6) {
    encodeOnce(words);
  } else if (what == "decode" && count == 6) {
    decodeOnce(words);
  } else if (what == "run" && count == 2) {
    runCommand(words[1]);
  } else {
    std::fputs("compare_codec is a part of benchmarks/compare.py; its source tells its words\n",
               stderr);
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace bspc::bench

int main(int argc, char** argv) {
  try {
    return bspc::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_codec: %s\n", error.what());
    return 1;
  }
}
