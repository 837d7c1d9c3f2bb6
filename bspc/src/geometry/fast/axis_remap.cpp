#include "geometry/fast/axis_remap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bspc/error.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "geometry/fast/chunk_streams.h"

namespace bspc::geometry::fast {

namespace {

/// What the next step between values depends on. Lattices whose steps are not whole numbers show as
/// patterns of two steps: two such lattices at once in the last three steps, a single one in how
/// long the last step has been repeated.
enum class StepPattern : std::uint8_t { Last = 0, LastThree = 1, Repeats = 2, Count = 3 };
constexpr unsigned kPatternBits = 2;

class StepContext {
 public:
  explicit StepContext(StepPattern pattern) : pattern_(pattern) {}

  static unsigned count(StepPattern pattern) { return pattern == StepPattern::Last ? 8 : 128; }
  unsigned index() const {
    const auto last = static_cast<unsigned>(std::min<std::uint64_t>(steps_[0], 7));
    switch (pattern_) {
      case StepPattern::LastThree:
        return (last * 4 + coarse(steps_[1])) * 4 + coarse(steps_[2]);
      case StepPattern::Repeats:
        return last * 16 + repeats_;
      default:
        return last;
    }
  }
  void push(std::uint64_t step) {
    repeats_ = step == steps_[0] ? std::min(repeats_ + 1, 15U) : 0;
    steps_[2] = steps_[1];
    steps_[1] = steps_[0];
    steps_[0] = step;
  }

 private:
  static unsigned coarse(std::uint64_t step) {
    return step <= 2 ? 0 : static_cast<unsigned>(std::min<std::uint64_t>(step, 5)) - 2;
  }
  StepPattern pattern_;
  std::uint64_t steps_[3] = {};
  unsigned repeats_ = 0;
};

/// Extents below so many times the number of points are looked at value by value.
constexpr std::uint64_t kDense = 64;
/// Extents up to here, and not above the number of points, have a byte a value.
constexpr std::uint32_t kBytes = 1U << 18;

/// Whether ranks of so many of an axis's values would be worth their list.
bool paysToRank(std::size_t points, double distinct, double range) {
  const double saved = std::log2(range / distinct);
  return distinct<0.9 * range&& static_cast<double>(points) * saved> 1.1 * distinct *
             (1.2 + saved) +
         256;
}

/// Gives up, and returns nothing, where values turn out too many.
std::vector<std::uint32_t> distinctInBytes(const AxisColumn& coordinates, std::uint32_t extent) {
  constexpr std::size_t kAtOnce = 4096;
  const double range = static_cast<double>(extent) + 1;
  std::vector<std::uint8_t> used(std::size_t{extent} + 1, 0);
  std::size_t distinct = 0;
  for (std::size_t first = 0; first < coordinates.size(); first += kAtOnce) {
    const std::size_t last = std::min(first + kAtOnce, coordinates.size());
    for (std::size_t i = first; i < last; ++i) {
      std::uint8_t& here = used[coordinates[i]];
      distinct += here ^ 1U;
      here = 1;
    }
    if (!paysToRank(coordinates.size(), static_cast<double>(distinct), range)) return {};
  }
  std::vector<std::uint32_t> values(distinct + 1);  // one is written in vain
  std::size_t count = 0;
  for (std::uint32_t c = 0; c <= extent; ++c) {
    values[count] = c;
    count += used[c];
  }
  values.pop_back();
  return values;
}

std::vector<std::uint32_t> distinctInBits(const AxisColumn& coordinates, std::uint32_t extent) {
  std::vector<std::uint64_t> used(extent / 64 + 1, 0);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    used[coordinates[i] / 64] |= std::uint64_t{1} << (coordinates[i] % 64);
  }
  std::vector<std::uint32_t> values;
  for (std::size_t word = 0; word < used.size(); ++word) {
    for (std::uint64_t bits = used[word]; bits != 0; bits &= bits - 1) {
      values.push_back(
          static_cast<std::uint32_t>(64 * word + static_cast<unsigned>(__builtin_ctzll(bits))));
    }
  }
  return values;
}

/// Over a wide range values rarely repeat; a sample tells whether these do.
std::vector<std::uint32_t> distinctSparse(const AxisColumn& coordinates) {
  constexpr std::size_t kSample = 1024;
  const std::size_t step = std::max<std::size_t>(coordinates.size() / kSample, 1);
  std::vector<std::uint32_t> values;
  const auto take = [&values, &coordinates](std::size_t hop) {
    values.clear();
    for (std::size_t i = 0; i < coordinates.size(); i += hop) values.push_back(coordinates[i]);
    const std::size_t taken = values.size();
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return taken;
  };
  const std::size_t sampled = take(step);
  if (sampled - values.size() < sampled / 64 + 1) return {};
  take(1);
  return values;
}

}  // namespace

std::vector<std::uint32_t> valuesWorthRanking(const AxisColumn& coordinates, std::uint32_t extent) {
  const std::size_t n = coordinates.size();
  if (n < 16 || extent < 2) return {};
  std::vector<std::uint32_t> values = extent < kBytes && extent <= n
                                          ? distinctInBytes(coordinates, extent)
                                      : extent / kDense < n ? distinctInBits(coordinates, extent)
                                                            : distinctSparse(coordinates);
  const double range = static_cast<double>(extent) + 1;
  if (!values.empty() && !paysToRank(n, static_cast<double>(values.size()), range)) values.clear();
  return values;
}

AxisRanks::AxisRanks(const AxisColumn& coordinates, const std::vector<std::uint32_t>& values) {
  if (values.empty()) return;
  // A table that stays small against the points, or else a search for each point.
  if (values.back() <= 2 * coordinates.size()) {
    kind_ = Kind::OfValue;
    ranks_.resize(std::size_t{values.back()} + 1);
    for (std::size_t r = 0; r < values.size(); ++r) {
      ranks_[values[r]] = static_cast<std::uint32_t>(r);
    }
    return;
  }
  kind_ = Kind::OfPoint;
  ranks_.resize(coordinates.size());
  for (std::size_t i = 0; i < ranks_.size(); ++i) {
    ranks_[i] = static_cast<std::uint32_t>(
        std::lower_bound(values.begin(), values.end(), coordinates[i]) - values.begin());
  }
}

bool isRegular(const std::vector<std::uint32_t>& values) {
  std::array<std::size_t, 256> steps{};
  for (std::size_t i = 1; i < values.size(); ++i) {
    ++steps[std::min<std::uint32_t>(values[i] - values[i - 1], 255)];
  }
  std::size_t seen = 0;
  std::size_t median = 0;
  while (median < 255 && (seen += steps[median]) * 2 < values.size()) ++median;
  if (median == 255) return false;
  const std::size_t near = steps[median] + (median > 0 ? steps[median - 1] : 0) + steps[median + 1];
  return near * 8 >= values.size() * 7;
}

namespace {

/// Bits of tables and symbols; extra bits are the same for every pattern.
double stepCost(const AxisValues& axes, StepPattern pattern) {
  std::vector<SymbolCounts> counts(StepContext::count(pattern));
  for (const std::vector<std::uint32_t>& values : axes) {
    StepContext context(pattern);
    for (std::size_t i = 1; i < values.size(); ++i) {
      const std::uint64_t step = std::uint64_t{values[i]} - values[i - 1];
      ++counts[context.index()][kStepCode.symbolOf(step - 1)];
      context.push(step);
    }
  }
  BitWriter bits;
  const std::vector<FrequencyTable> tables = writeTables(bits, counts, defaultFieldTables());
  auto cost = static_cast<double>(bits.bitCount());
  for (std::size_t t = 0; t < tables.size(); ++t) cost += tables[t].cost(counts[t]);
  return cost;
}

Bytes writeSteps(const AxisValues& axes, StepPattern pattern) {
  RansWriter symbols;
  BitWriter raw;
  for (const std::vector<std::uint32_t>& values : axes) {
    StepContext context(pattern);
    for (std::size_t i = 1; i < values.size(); ++i) {
      const std::uint64_t step = std::uint64_t{values[i]} - values[i - 1];
      const unsigned symbol = kStepCode.symbolOf(step - 1);
      symbols.symbol(context.index(), symbol);
      const unsigned extra = kStepCode.extraBits(symbol);
      if (extra > 0) raw.put(step - 1 - kStepCode.base(symbol), extra);
      context.push(step);
    }
  }
  const unsigned contexts = StepContext::count(pattern);
  BitWriter tables;
  tables.put(static_cast<std::uint64_t>(pattern), kPatternBits);
  const Bytes coded =
      symbols.finish(writeTables(tables, symbols.counts(contexts), defaultFieldTables()), 1);
  const Bytes head = tables.finish();
  container::ByteWriter out;
  for (const std::vector<std::uint32_t>& values : axes) {
    if (!values.empty()) out.varint(values.size());
  }
  out.varint(head.size());
  out.varint(coded.size());
  out.bytes(head);
  out.bytes(coded);
  out.bytes(raw.finish());
  return out.take();
}

}  // namespace

Bytes writeValues(const AxisValues& values) {
  StepPattern best = StepPattern::Last;
  double bestCost = stepCost(values, best);
  for (const StepPattern pattern : {StepPattern::LastThree, StepPattern::Repeats}) {
    const double cost = stepCost(values, pattern);
    if (cost >= bestCost) continue;
    best = pattern;
    bestCost = cost;
  }
  return writeSteps(values, best);
}

AxisValues readValues(ByteView section, const std::array<bool, 3>& ranked, std::uint64_t maxValues,
                      const GridPoint& extent, const OutputBudget& budget) {
  container::ByteReader reader(section, "the values of the axes of a tile",
                               container::ByteReader::kNoOffset);
  std::uint64_t counts[3] = {};
  for (unsigned k = 0; k < 3; ++k) {
    if (!ranked[k]) continue;
    counts[k] = reader.varint();
    if (counts[k] < 2 || counts[k] > maxValues || counts[k] > std::uint64_t{extent[k]} + 1) {
      reader.fail("an impossible number of values");
    }
  }
  const std::size_t headSize = reader.varint32();
  const std::size_t codedSize = reader.varint32();
  if (headSize > reader.remaining() || codedSize > reader.remaining() - headSize) {
    reader.fail("sections that are larger than it");
  }
  const ByteView rest = reader.bytes(reader.remaining());
  Bytes padded(rest.begin(), rest.end());
  padded.resize(rest.size() + kSectionPadding);
  BitReader head(padded.data(), headSize);
  const auto pattern = static_cast<StepPattern>(head.get(kPatternBits));
  if (pattern >= StepPattern::Count) reader.fail("an unknown pattern of steps");
  const TableSet tables(head, defaultFieldTables(), StepContext::count(pattern));
  head.expectEnd();
  RansReader symbols(padded.data() + headSize, codedSize, 1);
  BitReader raw(padded.data() + headSize + codedSize, rest.size() - headSize - codedSize);

  AxisValues axes;
  std::uint64_t kept = 0;
  for (unsigned k = 0; k < 3; ++k) {
    std::vector<std::uint32_t>& values = axes[k];
    if (counts[k] > 0) values.push_back(0);
    StepContext context(pattern);
    std::uint64_t value = 0;
    while (values.size() < counts[k]) {
      const unsigned symbol = symbols.symbol(tables[context.index()]);
      std::uint64_t step = kStepCode.base(symbol) + 1;
      if (const unsigned extra = kStepCode.extraBits(symbol); extra > 0) step += raw.get(extra);
      value += step;
      if (value > extent[k]) reader.fail("a value outside of the tile");
      if (values.size() == values.capacity()) budget.checkBytes(kept + 12 * values.size());
      values.push_back(static_cast<std::uint32_t>(value));
      context.push(step);
    }
    if (counts[k] > 0 && value != extent[k]) reader.fail("values that end before the tile does");
    kept += values.capacity() * sizeof(std::uint32_t);
  }
  symbols.expectEnd();
  raw.expectEnd();
  return axes;
}

}  // namespace bspc::geometry::fast
