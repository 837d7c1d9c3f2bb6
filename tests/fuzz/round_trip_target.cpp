// The input chooses points, arrays, cells and options; what is encoded must come back.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "bspc/part_encoder.h"
#include "bspc/stream_encoder.h"
#include "round_trip_input.h"
#include "streaming/stream_coding.h"
#include "target.h"

namespace bspc::fuzz {

namespace {

template <class T>
Bytes restoredAs(const Grid& grid, const DecodedPoints& decoded) {
  std::vector<T> xyz(3 * decoded.points.size());
  restorePositions(grid, decoded, xyz.data());
  Bytes bytes(xyz.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), xyz.data(), bytes.size());
  return bytes;
}

Bytes restored(const Grid& grid, const DecodedPoints& decoded) {
  switch (grid.scalarType) {
    case ScalarType::Float32:
      return restoredAs<float>(grid, decoded);
    case ScalarType::Float64:
      return restoredAs<double>(grid, decoded);
    case ScalarType::Int8:
      return restoredAs<std::int8_t>(grid, decoded);
    case ScalarType::UInt8:
      return restoredAs<std::uint8_t>(grid, decoded);
    case ScalarType::Int16:
      return restoredAs<std::int16_t>(grid, decoded);
    case ScalarType::UInt16:
      return restoredAs<std::uint16_t>(grid, decoded);
    case ScalarType::Int32:
      return restoredAs<std::int32_t>(grid, decoded);
    case ScalarType::UInt32:
      return restoredAs<std::uint32_t>(grid, decoded);
    case ScalarType::Int64:
      return restoredAs<std::int64_t>(grid, decoded);
    default:
      return restoredAs<std::uint64_t>(grid, decoded);
  }
}

std::string tupleOf(const ArrayValues& array, std::size_t i) {
  if (array.type == ScalarType::String) {
    std::string tuple;
    for (std::size_t c = 0; c < array.components; ++c) {
      tuple += array.strings[i * array.components + c] + '\0';
    }
    return tuple;
  }
  const std::size_t size = array.components * arrayValueSize(array.type);
  const auto first = array.values.begin() + static_cast<std::ptrdiff_t>(i * size);
  return {first, first + static_cast<std::ptrdiff_t>(size)};
}

/// Positions in which −0 is +0, as it is on a lattice.
Bytes withoutNegativeZeros(const RoundTripInput& input) {
  Bytes bytes = input.positions;
  const std::size_t width = scalarSize(input.type);
  if (!isFloatingPoint(input.type)) return bytes;
  for (std::size_t i = 0; i < bytes.size(); i += width) {
    const auto last = static_cast<std::ptrdiff_t>(i + width - 1);
    const bool zero = std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                                  bytes.begin() + last, [](std::uint8_t b) { return b == 0; });
    if (zero && bytes[i + width - 1] == 0x80) bytes[i + width - 1] = 0;
  }
  return bytes;
}

/// An encoded input and what came back.
class Comparison {
 public:
  Comparison(const RoundTripInput& input, const EncodeReport& report, const DecodedPoints& decoded)
      : input_(input),
        report_(report),
        decoded_(decoded),
        given_(input.options.grid.kind == GridRequest::Kind::ExactFloats
                   ? input.positions
                   : withoutNegativeZeros(input)),
        back_(restored(report.grid, decoded)) {}

  void check() const {
    if (report_.grid.scalarType != input_.type) fail("positions of another type");
    if (decoded_.points.size() + report_.dropped != input_.size()) fail("other points");
    if (report_.order.size() != decoded_.points.size()) fail("an order of other points");
    checkOrder();
    checkPositions();
    checkArrays();
    if (report_.dropped == 0) checkCells();
  }

 private:
  void checkOrder() const {
    std::vector<std::uint64_t> order = report_.order;
    if (input_.options.keepOrder && !std::is_sorted(order.begin(), order.end())) {
      fail("an order that was not kept");
    }
    std::sort(order.begin(), order.end());
    if (std::adjacent_find(order.begin(), order.end()) != order.end()) fail("a point twice");
    if (!order.empty() && order.back() >= input_.size()) fail("an order beyond the points");
  }

  void checkPositions() const {
    const std::size_t size = 3 * scalarSize(input_.type);
    const PointSetView given(given_.data(), input_.type, input_.size(), 0);
    const PointSetView back(back_.data(), input_.type, decoded_.points.size(), 0);
    for (std::size_t j = 0; j < report_.order.size(); ++j) {
      const auto i = static_cast<std::size_t>(report_.order[j]);
      if (report_.exact) {
        if (std::memcmp(&given_[i * size], &back_[j * size], size) != 0) fail("another position");
        continue;
      }
      const std::array<double, 3> a = given.position(i);
      const std::array<double, 3> b = back.position(j);
      for (std::size_t k = 0; k < 3; ++k) {
        if (std::abs(a[k] - b[k]) > report_.maxError[k]) fail("an error that was not told");
      }
    }
  }

  void checkArrays() const {
    const std::size_t expected = input_.arrays.size() + (input_.options.originalIds ? 1 : 0);
    if (decoded_.arrays.size() != expected || report_.arrays.size() != expected) {
      fail("other arrays");
    }
    for (std::size_t a = 0; a < expected; ++a) {
      const ArrayValues& back = decoded_.arrays[a];
      const auto found =
          std::find_if(input_.arrays.begin(), input_.arrays.end(),
                       [&](const ArrayValues& given) { return given.name == back.name; });
      if (found == input_.arrays.end()) {
        checkIds(back);
      } else {
        checkArray(*found, back, report_.order, report_.arrays[a]);
      }
    }
  }

  void checkIds(const ArrayValues& ids) const {
    for (std::size_t j = 0; j < report_.order.size(); ++j) {
      std::uint64_t id = 0;
      std::memcpy(&id, &ids.values[8 * j], 8);
      if (id != report_.order[j]) fail("another id");
    }
  }

  static void checkArray(const ArrayValues& given, const ArrayValues& back,
                         const std::vector<std::uint64_t>& order, const ArrayReport& report) {
    if (back.type != given.type || back.components != given.components ||
        back.semantic != given.semantic || back.tuples() != order.size()) {
      fail("an array of another kind");
    }
    if (report.greatestError > given.tolerance) fail("a tolerance that was not heeded");
    if (report.greatestError > 0) return;
    for (std::size_t j = 0; j < order.size(); ++j) {
      if (tupleOf(back, j) != tupleOf(given, static_cast<std::size_t>(order[j]))) {
        fail("another value");
      }
    }
  }

  void checkCells() const {
    if (report_.cellOrder.size() != input_.cells.size()) fail("an order of other cells");
    std::size_t before = 0;
    before += checkSort(input_.cells.vertices, decoded_.mesh.vertices, before, 0);
    before += checkSort(input_.cells.lines, decoded_.mesh.lines, before, 1);
    checkSort(input_.cells.faces, decoded_.mesh.faces, before, 2);
    const std::size_t arrays = input_.cells.empty() ? 0 : input_.cellArrays.size();
    if (decoded_.cellArrays.size() != arrays) fail("other arrays of cells");
    for (std::size_t a = 0; a < arrays; ++a) {
      checkArray(input_.cellArrays[a], decoded_.cellArrays[a], report_.cellOrder,
                 report_.cellArrays[a]);
    }
  }

  std::size_t checkSort(const Cells& given, const Cells& back, std::size_t before,
                        unsigned sort) const {
    if (back.size() != given.size()) fail("other cells");
    for (std::size_t i = 0; i < back.size(); ++i) {
      const auto number = static_cast<std::size_t>(report_.cellOrder[before + i]);
      if (number < before || number - before >= given.size()) fail("a cell of another sort");
      std::vector<std::uint64_t> corners;
      for (const std::uint32_t v : back[i]) corners.push_back(report_.order[v]);
      std::vector<std::uint64_t> wanted(given[number - before].begin(),
                                        given[number - before].end());
      if (!sameCell(corners, wanted, sort)) fail("another cell");
    }
    return given.size();
  }

  bool sameCell(std::vector<std::uint64_t> a, std::vector<std::uint64_t> b, unsigned sort) const {
    if (a == b) return true;
    if (sort == 1 || input_.options.keepOrder || a.size() != b.size()) return false;
    if (sort == 0) {
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      return a == b;
    }
    for (std::size_t turn = 0; turn < a.size() && a != b; ++turn) {
      std::rotate(a.begin(), a.begin() + 1, a.end());
    }
    return a == b;
  }

  const RoundTripInput& input_;
  const EncodeReport& report_;
  const DecodedPoints& decoded_;
  Bytes given_;
  Bytes back_;
};

bool sameMetadata(const Metadata& a, const Metadata& b) {
  if (a.crs != b.crs || a.lengthUnit != b.lengthUnit || a.entries != b.entries ||
      a.fieldData.size() != b.fieldData.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.fieldData.size(); ++i) {
    const ArrayValues& x = a.fieldData[i];
    const ArrayValues& y = b.fieldData[i];
    if (x.name != y.name || x.values != y.values || x.strings != y.strings) return false;
  }
  return true;
}

DecodeOptions oneThread() {
  DecodeOptions options;
  options.threads = 1;
  return options;
}

/// Each level has the points that the file says, which stand for all points.
void checkLevels(Decoder& decoder) {
  const FileInfo& info = decoder.info();
  for (unsigned level = 0; level + 1 < info.layers.size() && level < 6; ++level) {
    DecodeOptions options = oneThread();
    options.level = level;
    options.wantCounts = true;
    const DecodedPoints decoded = decoder.decode(options);
    std::uint64_t points = 0;
    for (const std::uint64_t count : decoded.counts) points += count;
    if (decoded.points.size() != info.layers[level].points || points != info.points) {
      fail("a level with other points");
    }
  }
}

/// Refuses what an encoder or a decoder must not say of input that is whole.
void checkRefusal(const Error& error) {
  switch (error.code()) {
    case ErrorCode::InvalidArgument:
    case ErrorCode::NonFinite:
    case ErrorCode::OutOfGrid:
    case ErrorCode::Unsupported:
      return;  // not every wish goes with every method
    default:
      fail("an encoder that says: " + std::string(error.what()));
  }
}

void goAround(const RoundTripInput& input) {
  MemorySink sink;
  EncodeReport report;
  try {
    report = encode(input.view(), sink, input.options);
  } catch (const Error& error) {
    checkRefusal(error);
    return;
  }
  Decoder decoder(std::make_shared<MemorySource>(sink.bytes()));
  const DecodedPoints decoded = decoder.decode(oneThread());
  Comparison(input, report, decoded).check();
  if (!sameMetadata(decoder.info().metadata, input.options.metadata)) fail("other metadata");
  if (sink.bytes().size() != report.fileBytes) fail("a file of another size");
  checkLevels(decoder);
}

/// Gives the points of an input in pieces.
class PieceReader final : public PointReader {
 public:
  explicit PieceReader(const RoundTripInput& input) : input_(input) {
    for (const ArrayValues& array : input.arrays) descriptions_.push_back(array);
  }
  ScalarType type() const override { return input_.type; }
  const std::vector<ArrayDescription>& arrays() const override { return descriptions_; }
  std::size_t read(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count) override {
    constexpr std::size_t kPiece = 17;
    const auto left = static_cast<std::size_t>(input_.size()) - at_;
    const std::size_t got = std::min({count, kPiece, left});
    const std::size_t size = 3 * scalarSize(input_.type);
    if (got > 0) std::memcpy(xyz, input_.positions.data() + at_ * size, got * size);
    for (std::size_t a = 0; a < values.size(); ++a) {
      const ArrayValues& from = input_.arrays[a];
      for (std::size_t i = at_; i < at_ + got; ++i) {
        if (from.type == ScalarType::String) {
          const auto first =
              from.strings.begin() + static_cast<std::ptrdiff_t>(i * from.components);
          values[a].strings.insert(values[a].strings.end(), first, first + from.components);
        } else {
          const std::string tuple = tupleOf(from, i);
          values[a].values.insert(values[a].values.end(), tuple.begin(), tuple.end());
        }
      }
    }
    at_ += got;
    return got;
  }

 private:
  const RoundTripInput& input_;
  std::vector<ArrayDescription> descriptions_;
  std::size_t at_ = 0;
};

/// A stream that fits into memory is coded as the whole is at once.
void goAroundAsStream(const RoundTripInput& input) {
  StreamOptions options;
  options.encoding = input.options;
  options.encoding.wantOrder = false;
  MemorySink whole;
  MemorySink stream;
  try {
    encode(input.part(0, input.size()), whole, options.encoding);
  } catch (const Error& error) {
    checkRefusal(error);
    return;
  }
  try {
    PieceReader reader(input);
    encodeStream(reader, stream, options);
  } catch (const Error& error) {
    fail("a stream that is refused: " + std::string(error.what()));
  }
  if (stream.bytes() != whole.bytes()) fail("a stream that is coded otherwise");
}

class Scratch final : public ScratchStorage {
 public:
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override {
    MemorySource(bytes_).read(offset, into);
  }
  void append(ByteView bytes) override { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

 private:
  Bytes bytes_;
};

/// The input indices of decoded points, from the only array that was not given.
std::vector<std::uint64_t> idsOf(const DecodedPoints& decoded, const RoundTripInput& input) {
  for (const ArrayValues& array : decoded.arrays) {
    const bool given = std::any_of(input.arrays.begin(), input.arrays.end(),
                                   [&](const ArrayValues& a) { return a.name == array.name; });
    if (given) continue;
    if (array.values.size() != 8 * decoded.points.size()) fail("ids of other points");
    std::vector<std::uint64_t> ids(decoded.points.size());
    if (!ids.empty()) std::memcpy(ids.data(), array.values.data(), array.values.size());
    return ids;
  }
  fail("no ids");
}

/// A stream that does not fit into memory.
void goAroundThroughScratch(RoundTripInput input, std::uint64_t memory) {
  input.cells = {};
  input.cellArrays.clear();
  input.options.originalIds = true;
  StreamOptions options;
  options.encoding = input.options;
  options.encoding.wantOrder = false;
  options.scratch = [] { return std::make_unique<Scratch>(); };
  MemorySink sink;
  EncodeReport report;
  try {
    PieceReader reader(input);
    report = streaming::encodeStreamWithin(memory, reader, sink, options);
  } catch (const Error& error) {
    checkRefusal(error);
    return;
  }
  Decoder decoder(std::make_shared<MemorySource>(sink.bytes()));
  const DecodedPoints decoded = decoder.decode(oneThread());
  report.order = idsOf(decoded, input);
  Comparison(input, report, decoded).check();
  if (!sameMetadata(decoder.info().metadata, input.options.metadata)) fail("other metadata");
  if (sink.bytes().size() != report.fileBytes) fail("a file of another size");
  checkLevels(decoder);
}

/// Several writers of one file.
void goAroundInParts(const RoundTripInput& input) {
  EncodeOptions options = input.options;
  options.wantOrder = false;
  const std::uint64_t half = input.size() / 3;
  const PointSetView views[] = {input.part(0, half), input.part(half, input.size() - half)};
  Bytes file;
  std::uint64_t dropped = 0;
  try {
    std::vector<Bytes> messages;
    for (const PointSetView& view : views) messages.push_back(describePart(view, options));
    const EncodeOptions agreed = agreeOnParts(messages, options);
    std::vector<FilePart> parts;
    std::vector<Bytes> summaries;
    for (const PointSetView& view : views) {
      parts.push_back(encodePart(view, agreed));
      summaries.push_back(parts.back().summary);
      dropped += parts.back().report.dropped;
    }
    const FileFrame frame = frameParts(summaries);
    file = frame.head;
    for (const FilePart& part : parts)
      file.insert(file.end(), part.tiles.begin(), part.tiles.end());
    file.insert(file.end(), frame.end.begin(), frame.end.end());
  } catch (const Error& error) {
    checkRefusal(error);
    return;
  }
  Decoder decoder(std::make_shared<MemorySource>(file));
  const DecodedPoints decoded = decoder.decode(oneThread());
  if (decoded.points.size() + dropped != input.size()) fail("other points in parts");
  std::vector<std::string> given;
  std::vector<std::string> back;
  for (const ArrayValues& array : input.arrays) {
    if (array.tolerance > 0 || dropped > 0) continue;
    const auto found = std::find_if(decoded.arrays.begin(), decoded.arrays.end(),
                                    [&](const ArrayValues& a) { return a.name == array.name; });
    if (found == decoded.arrays.end()) fail("an array lost in parts");
    for (std::size_t i = 0; i < input.size(); ++i) {
      given.push_back(tupleOf(array, i));
      back.push_back(tupleOf(*found, i));
    }
  }
  std::sort(given.begin(), given.end());
  std::sort(back.begin(), back.end());
  if (given != back) fail("other values in parts");
}

void runRoundTrip(ByteView bytes) {
  Choices choices(bytes);
  const std::uint64_t way = choices.below(16);
  const std::uint64_t memory = way == 2 || way == 3 ? 1 + choices.below(1U << 14) : 0;
  const RoundTripInput input(choices);
  try {
    goAround(input);
    if (way == 0) goAroundInParts(input);
    if (way == 1) goAroundAsStream(input);
    if (way == 2 || way == 3) goAroundThroughScratch(input, memory);
  } catch (const Error& error) {
    fail("a decoder that refuses what was encoded: " + std::string(error.what()));
  }
}

std::vector<Bytes> roundTripSeeds() {
  std::vector<Bytes> seeds;
  Random random(1);
  for (std::size_t size = 16; size < 1500; size = size * 5 / 4) {
    Bytes seed(size);
    for (std::uint8_t& byte : seed) byte = static_cast<std::uint8_t>(random.bits());
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

}  // namespace

Target roundTripTarget() {
  Target target;
  target.name = "round_trip";
  target.run = runRoundTrip;
  target.seeds = roundTripSeeds;
  return target;
}

}  // namespace bspc::fuzz
