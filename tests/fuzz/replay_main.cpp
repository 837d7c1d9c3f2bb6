// Runs a target without libFuzzer, by any compiler: its seeds, inputs that once failed, and a fixed
// number of mutations of them, the same ones each time.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "target.h"

namespace {

using bspc::Bytes;
using bspc::ByteView;
using bspc::fuzz::Random;
using bspc::fuzz::Target;

constexpr const char* kUsage =
    "Usage: bspc_fuzz_replay TARGET --seeds FOLDER    writes the target's seeds\n"
    "       bspc_fuzz_replay TARGET --run MUTATIONS   runs its seeds, its findings that were "
    "kept,\n"
    "                                                 and so many mutations of them\n"
    "       bspc_fuzz_replay TARGET FILE...           runs these inputs\n";

/// A ByteMutator has no room for a state of its own.
Random& byteRandom() {
  static Random random(0);
  return random;
}

/// What libFuzzer's own mutator is for: some bytes otherwise.
std::size_t changeBytes(std::uint8_t* data, std::size_t size, std::size_t maxSize) {
  Random& random = byteRandom();
  constexpr std::array<std::uint8_t, 8> kEnds{0, 1, 0x7F, 0x80, 0xFF, 0xFE, 0x10, 0x20};
  const std::uint64_t changes = 1 + random.below(random.oneIn(4) ? 8 : 2);
  for (std::uint64_t i = 0; i < changes; ++i) {
    const auto at = static_cast<std::size_t>(random.below(size));
    const auto other = static_cast<std::size_t>(random.below(size));
    const std::size_t count =
        std::min<std::size_t>(1 + static_cast<std::size_t>(random.below(8)), size - at);
    switch (size == 0 ? 4 : random.below(6)) {
      case 0:
        data[at] = static_cast<std::uint8_t>(data[at] ^ 1U << random.below(8));
        break;
      case 1:
        data[at] = static_cast<std::uint8_t>(random.bits());
        break;
      case 2:
        data[at] = kEnds[static_cast<std::size_t>(random.below(kEnds.size()))];
        break;
      case 3:
        std::copy_n(data + other, std::min(count, size - other), data + at);
        break;
      case 4:
        if (size == maxSize) break;
        std::copy_backward(data + at, data + size, data + size + 1);
        data[at] = static_cast<std::uint8_t>(random.bits());
        ++size;
        break;
      default:
        std::copy(data + at + count, data + size, data + at);
        size -= count;
        break;
    }
  }
  return size;
}

Bytes readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeFile(const std::filesystem::path& path, ByteView bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt" && entry.path().extension() != ".md") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Bytes> seedsOf(const Target& target) {
  const std::filesystem::path data(BSPC_TEST_DATA);
  std::vector<Bytes> seeds;
  if (target.seeds != nullptr) seeds = target.seeds();
  for (const std::string& folder : target.seedFolders) {
    for (const auto& file : filesOf(data / folder)) {
      seeds.push_back(readFile(file));
      seeds.back().resize(seeds.back().size() + target.suffix);
    }
  }
  return seeds;
}

void writeSeeds(const Target& target, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::size_t number = 0;
  for (const Bytes& seed : seedsOf(target)) {
    writeFile(folder / ("seed_" + std::to_string(number++)), seed);
  }
}

/// Where a target that ends the program leaves its input.
void runKept(const Target& target, ByteView input) {
  writeFile("fuzz_input_" + target.name, input);
  target.run(input);
}

void run(const Target& target, std::uint64_t mutations, std::uint64_t number) {
  constexpr std::size_t kMaxSize = 4096;
  std::vector<Bytes> inputs = seedsOf(target);
  const std::size_t seeds = inputs.size();
  const std::filesystem::path kept = std::filesystem::path(BSPC_TEST_DATA) / "fuzz" / target.name;
  for (const auto& file : filesOf(kept)) inputs.push_back(readFile(file));
  if (inputs.empty()) throw std::runtime_error("there are no seeds");
  for (const Bytes& input : inputs) runKept(target, input);
  Random random(2 * number);
  byteRandom() = Random(2 * number + 1);
  std::vector<Bytes> small;
  for (const Bytes& input : inputs) {
    if (input.size() <= kMaxSize) small.push_back(input);
  }
  Bytes input;
  for (std::uint64_t i = 0; i < mutations; ++i) {
    // Half of them build on the last one.
    if (input.empty() || random.oneIn(2)) {
      input = small[static_cast<std::size_t>(random.below(small.size()))];
    }
    if (target.mutate != nullptr) {
      input = target.mutate(input, kMaxSize, random, changeBytes);
    } else {
      const std::size_t size = input.size();
      input.resize(kMaxSize);
      input.resize(changeBytes(input.data(), size, kMaxSize));
    }
    runKept(target, input);
  }
  std::cout << target.name << ": " << seeds << " seeds, " << inputs.size() - seeds << " findings, "
            << mutations << " mutations\n";
}

int perform(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) {
    std::cerr << kUsage;
    return 2;
  }
  const std::vector<Target> all = bspc::fuzz::targets();
  const auto target =
      std::find_if(all.begin(), all.end(), [&](const Target& t) { return t.name == arguments[0]; });
  if (target == all.end()) {
    std::cerr << "bspc_fuzz_replay: there is no target " << arguments[0] << '\n';
    return 2;
  }
  if (arguments[1] == "--seeds" && arguments.size() == 3) {
    writeSeeds(*target, arguments[2]);
  } else if (arguments[1] == "--run" && arguments.size() > 2) {
    run(*target, std::stoull(arguments[2]), arguments.size() > 3 ? std::stoull(arguments[3]) : 0);
  } else {
    for (std::size_t i = 1; i < arguments.size(); ++i) target->run(readFile(arguments[i]));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return perform(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::cerr << "bspc_fuzz_replay: " << error.what() << '\n';
    return 1;
  }
}
