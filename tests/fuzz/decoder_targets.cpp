// Any bytes as a .bspc file: all of it, and parts of it.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "bspc/join.h"
#include "file_model.h"
#include "file_mutator.h"
#include "fuzz_limits.h"
#include "round_trip_input.h"
#include "target.h"

namespace bspc::fuzz {

namespace {

OpenOptions openOptions(bool allowPartial) {
  OpenOptions options;
  options.limits = smallLimits();
  options.allowPartial = allowPartial;
  return options;
}

std::shared_ptr<ByteSource> sourceOf(ByteView file) { return std::make_shared<MemorySource>(file); }

void checkCells(const Cells& cells, std::size_t points) {
  if (!cells.ends.empty() && cells.ends.back() != cells.indices.size()) fail("loose ends of cells");
  for (const std::uint32_t i : cells.indices) {
    if (i >= points) fail("a cell of a point that there is not");
  }
}

/// What must hold of all that is returned.
void checkResult(const DecodedPoints& decoded, bool withCounts) {
  const std::size_t points = decoded.points.size();
  for (const ArrayValues& array : decoded.arrays) {
    if (array.tuples() != points) fail("an array that has not a tuple a point");
  }
  for (const ArrayValues& array : decoded.cellArrays) {
    if (array.tuples() != decoded.mesh.size()) fail("an array that has not a tuple a cell");
  }
  if (!decoded.lowHalves.empty() && decoded.lowHalves.size() != points) fail("missing low halves");
  if (withCounts && decoded.counts.size() != points) fail("missing counts");
  checkCells(decoded.mesh.vertices, points);
  checkCells(decoded.mesh.lines, points);
  checkCells(decoded.mesh.faces, points);
}

/// A file that decodes can be joined with itself, and what comes of it decodes.
void checkJoin(ByteView file, std::size_t points) {
  JoinOptions options;
  options.limits = smallLimits();
  options.layout = file.size() % 2 == 0 ? Layout::Progressive : Layout::Streaming;
  MemorySink sink;
  join({sourceOf(file), sourceOf(file)}, sink, options);
  try {
    DecodeOptions decoding;
    decoding.threads = 1;
    Decoder decoder(sourceOf(sink.bytes()), openOptions(false));
    if (decoder.decode(decoding).points.size() != 2 * points) fail("joined files lost points");
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitExceeded)
      fail("a joined file: " + std::string(error.what()));
  }
}

/// Decodes all of a file. True if it was refused for its content.
bool decodeAll(ByteView file) {
  try {
    const bool counts = file.size() % 4 == 1;
    Decoder decoder(sourceOf(file), openOptions(file.size() % 2 == 0));
    DecodeOptions options;
    options.threads = 1;
    options.wantCounts = counts;
    const DecodedPoints decoded = decoder.decode(options);
    checkResult(decoded, counts);
    const FileInfo& info = decoder.info();
    if (decoded.complete && decoded.points.size() != info.points) fail("a decoding lacks points");
    if (decoded.complete && !info.mesh.missing && decoded.points.size() < 200) {
      checkJoin(file, decoded.points.size());
    }
  } catch (const Error& error) {
    return error.code() == ErrorCode::Corrupt;
  }
  return false;
}

void runDecode(ByteView input) {
  if (!decodeAll(input)) return;
  // Perhaps only because the decoded points are others than those whose checksum the file has.
  const Bytes right = withRightContents(input);
  if (!right.empty() && !std::equal(right.begin(), right.end(), input.begin(), input.end())) {
    decodeAll(right);
  }
}

/// Bytes behind the file that choose what is asked for.
constexpr std::size_t kQueryBytes = 24;

Box chosenBox(Choices& choices, const FileInfo& info) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const std::uint64_t width = std::uint64_t{info.upper[axis]} - info.lower[axis] + 1;
    const auto place = [&] {
      return restoredCoordinate(
          info.grid, k,
          static_cast<std::uint32_t>(info.lower[axis] + choices.below(256) * width / 256));
    };
    const double a = place();
    const double b = place();
    box.lower[axis] = std::min(a, b);
    box.upper[axis] = std::max(a, b);
  }
  return box;
}

DecodeOptions chosenQuery(Choices& choices, const FileInfo& info) {
  DecodeOptions options;
  options.threads = 1;
  options.wantCounts = choices.yes();
  if (choices.yes()) options.level = static_cast<unsigned>(choices.below(info.layers.size() + 1));
  if (choices.yes()) options.maxPoints = choices.below(1000);
  if (choices.yes()) options.cellLevel = static_cast<unsigned>(choices.below(4));
  if (choices.yes() && !info.tiles.empty()) {
    options.tiles = TileRange{choices.below(info.tiles.size() + 1), choices.below(4)};
  }
  if (choices.yes()) options.box = chosenBox(choices, info);
  if (choices.yes()) {
    options.arrays.emplace();
    for (const ArrayInfo& array : info.arrays) {
      if (choices.yes()) options.arrays->push_back(array.name);
    }
  }
  return options;
}

void checkQuery(const DecodeOptions& options, const Decoder& decoder,
                const DecodedPoints& decoded) {
  checkResult(decoded, options.wantCounts);
  if (options.maxPoints && decoded.points.size() > *options.maxPoints) fail("too many points");
  if (options.cellLevel && decoded.cellIds.size() != decoded.points.size()) fail("missing ids");
  // Coarse levels of exact float64 positions have the upper halves alone.
  if (!options.box || decoder.info().grid.form == Grid::Form::FloatBits) return;
  for (const GridPoint& point : decoded.points) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double x = restoredCoordinate(decoder.info().grid, k, point[axis]);
      if (x < options.box->lower[axis] || x > options.box->upper[axis]) {
        fail("a point outside the box");
      }
    }
  }
}

void ask(ByteView file, Choices choices, bool& corrupt) {
  try {
    Decoder decoder(sourceOf(file), openOptions(true));
    const DecodeOptions options = chosenQuery(choices, decoder.info());
    const QueryCost cost = decoder.cost(options);
    if (cost.bytes > file.size()) fail("a query that reads more than the file");
    const DecodedPoints decoded = decoder.decode(options);
    checkQuery(options, decoder, decoded);
    std::size_t points = 0;
    decoder.decodeTiles(options, [&](const DecodedPoints& part) {
      checkResult(part, options.wantCounts);
      points += part.points.size();
    });
    if (!options.maxPoints && points != decoded.points.size()) fail("tiles with other points");
  } catch (const Error& error) {
    corrupt = error.code() == ErrorCode::Corrupt;
  }
}

void runQuery(ByteView input) {
  if (input.size() < kQueryBytes) return;
  const ByteView file = input.subspan(0, input.size() - kQueryBytes);
  const Choices choices(input.subspan(file.size(), kQueryBytes));
  bool corrupt = false;
  ask(file, choices, corrupt);
  if (!corrupt) return;
  const Bytes right = withRightContents(file);
  if (!right.empty()) ask(right, choices, corrupt);
}

Bytes mutateQuery(ByteView input, std::size_t maxSize, Random& random, ByteMutator changeBytes) {
  if (input.size() < kQueryBytes || maxSize < kQueryBytes) {
    return Bytes(std::min(kQueryBytes, maxSize));
  }
  Bytes file(input.begin(), input.end() - kQueryBytes);
  Bytes query(input.end() - kQueryBytes, input.end());
  if (random.oneIn(2)) {
    for (std::uint64_t i = 0; i <= random.below(3); ++i) {
      query[static_cast<std::size_t>(random.below(kQueryBytes))] =
          static_cast<std::uint8_t>(random.bits());
    }
  } else {
    file = mutateFile(file, maxSize - kQueryBytes, random, changeBytes);
  }
  file.insert(file.end(), query.begin(), query.end());
  return file;
}

std::vector<Bytes> querySeeds() {
  std::vector<Bytes> seeds = fileSeeds();
  for (Bytes& seed : seeds) seed.resize(seed.size() + kQueryBytes);
  return seeds;
}

}  // namespace

std::vector<Bytes> fileSeeds() {
  constexpr std::size_t kMostBytes = 600;
  std::vector<Bytes> seeds;
  Random random(2);
  while (seeds.size() < 120) {
    Bytes wishes(100 + static_cast<std::size_t>(random.below(500)));
    for (std::uint8_t& byte : wishes) byte = static_cast<std::uint8_t>(random.bits());
    Choices choices(wishes);
    const RoundTripInput input(choices);
    if (input.size() == 0) continue;
    try {
      MemorySink sink;
      encode(input.view(), sink, input.options);
      if (sink.bytes().size() <= kMostBytes) seeds.push_back(sink.take());
    } catch (const Error&) {
      continue;  // not every wish goes with every method
    }
  }
  return seeds;
}

Target fileTarget(const std::string& name, void (*run)(ByteView input)) {
  Target target;
  target.name = name;
  target.run = run;
  target.mutate = mutateFile;
  target.seeds = fileSeeds;
  target.seedFolders = {"conformance", "frozen_1.0", "golden"};
  return target;
}

Target decodeTarget() { return fileTarget("decode", runDecode); }

Target queryTarget() {
  Target target = fileTarget("query", runQuery);
  target.mutate = mutateQuery;
  target.seeds = querySeeds;
  target.suffix = kQueryBytes;
  return target;
}

}  // namespace bspc::fuzz
