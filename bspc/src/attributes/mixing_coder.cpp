#include "attributes/mixing_coder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "attributes/logistic_mixer.h"
#include "attributes/prediction_weights.h"
#include "attributes/residual_models.h"
#include "entropy/symbol_coder.h"

namespace bspc::attributes {

namespace {

constexpr unsigned kContexts = 7;
constexpr unsigned kNodes = 256;

/// Where a bit stands in the code of a value: a class in unary, then the bits behind the leading
/// one. Sixteen neighbouring nodes of a context share a line of its table.
class NodeTables {
 public:
  /// Tables for that many values.
  explicit NodeTables(std::uint64_t values) {
    const unsigned bits = std::clamp(entropy::bitLength(values) + 1, kLeastBits, kMostBits);
    mask_ = (1U << bits) - 1;
    for (auto& table : tables_) table.resize((std::size_t{mask_} + 1) * kLine);
  }

  void select(unsigned context, std::uint32_t value, unsigned slot) {
    std::uint32_t hash = (value * kSlots + slot + 1) * 0x9E3779B1U + context * 0x85EBCA6BU;
    hash ^= hash >> 15;
    hash *= 0x2C1B3C6DU;
    selected_[context] = hash >> 16;
  }

  std::array<ContextBit*, kContexts> at(unsigned node) {
    std::array<ContextBit*, kContexts> bits;
    for (unsigned c = 0; c < kContexts; ++c) {
      const std::uint32_t line = (selected_[c] + (node / kLine) * 0x9E5U) & mask_;
      bits[c] = &tables_[c][std::size_t{line} * kLine + node % kLine];
    }
    return bits;
  }

 private:
  static constexpr std::uint32_t kLine = 16;
  static constexpr unsigned kLeastBits = 8;
  static constexpr unsigned kMostBits = 14;
  std::uint32_t mask_ = 0;
  std::array<std::vector<ContextBit>, kContexts> tables_;
  std::array<std::uint32_t, kContexts> selected_{};
};

/// How the error of a component's prediction follows from the error of the component before: a
/// regression that forgets.
class ErrorRegression {
 public:
  double correction(double before) const { return slope_ * before; }

  void learn(double before, double error) {
    constexpr double kMemory = 0.9995;
    products_ = products_ * kMemory + error * before;
    squares_ = squares_ * kMemory + before * before;
    slope_ = products_ / (squares_ + 1.0);
  }

 private:
  double products_ = 0;
  double squares_ = 1;
  double slope_ = 0;
};

template <class Coder>
class MixingCoder {
 public:
  MixingCoder(Coder& coder, const RankedPoints& points, const NeighbourTable& neighbours,
              std::uint32_t components, std::vector<std::uint8_t>& values)
      : coder_(coder),
        points_(points),
        neighbours_(neighbours),
        components_(components),
        values_(values),
        weights_(points, Predictor::MeanOf8, 0),
        tables_((points.size() - points.known) * std::uint64_t{components}),
        mixers_(std::size_t{kSlots} * kNodes, MixerWeights<kContexts>(kStartWeight)),
        misses_((points.size() - points.known) * components) {}

  void run(std::size_t limit) {
    const std::size_t end = points_.known + std::min(limit, points_.size() - points_.known);
    for (std::size_t rank = points_.known; rank < end; ++rank) {
      weights_.find(static_cast<std::uint32_t>(rank), neighbours_.of(rank), near_);
      double before = 0;
      for (std::uint32_t c = 0; c < components_; ++c) before = codeComponent(rank, c, before);
    }
  }

 private:
  static constexpr std::int32_t kStartWeight = 65536 * 10 / 42;

  int neighbour(std::size_t j, std::uint32_t component) const {
    if (near_.ranks.empty()) return 0;
    const std::size_t rank = near_.ranks[std::min(j, near_.ranks.size() - 1)];
    return values_[rank * components_ + component];
  }

  /// Codes a component; returns the rounded error of its mean. `before` is that of the last one.
  double codeComponent(std::size_t rank, std::uint32_t c, double before) {
    const unsigned slot = std::min(c, kSlots - 1);
    double mean = 0;
    int least = 255;
    int greatest = 0;
    for (std::size_t j = 0; j < near_.ranks.size(); ++j) {
      const int value = neighbour(j, c);
      mean += near_.weights[j] * static_cast<double>(value);
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    const double corrected = mean + (c > 0 ? regressions_[slot].correction(before) : 0.0);
    const int expected = static_cast<int>(std::clamp(std::floor(corrected + 0.5), 0.0, 255.0));
    const int nearest = neighbour(0, c);
    selectContexts(rank, c, expected, greatest > least ? greatest - least : 0);

    std::uint8_t& value = values_[rank * components_ + c];
    value = static_cast<std::uint8_t>(nearest + codeDifference(slot, value - nearest));
    misses_[(rank - points_.known) * components_ + c] =
        static_cast<std::uint8_t>(std::abs(value - expected));
    const double error = static_cast<double>(value) - mean;
    if (c > 0) regressions_[slot].learn(before, error);
    return std::floor(error + 0.5);
  }

  static std::uint32_t limited(int v, int greatest) {
    return static_cast<std::uint32_t>(std::clamp(v, -greatest, greatest) + greatest);
  }

  void selectContexts(std::size_t rank, std::uint32_t c, int expected, int spread) {
    const unsigned slot = std::min(c, kSlots - 1);
    const std::uint8_t* tuple = values_.data() + rank * components_;
    const int n1 = neighbour(0, c);
    const int second = neighbour(1, c) - n1;
    const int third = neighbour(2, c) - n1;
    const int ahead = expected - n1;
    const int last = c > 0 ? tuple[c - 1] : 0;
    const int step1 = c > 0 ? tuple[c - 1] - neighbour(0, c - 1) : 0;
    const int step2 = c > 1 ? tuple[c - 2] - neighbour(0, c - 2) : 0;
    const auto near = static_cast<std::uint32_t>(n1);
    const std::uint32_t spreadClass = std::min(halfOctave(static_cast<unsigned>(spread)), 15U);
    tables_.select(0, near * 256 + static_cast<std::uint32_t>(last), slot);
    tables_.select(1, limited(step1, 31) * 64 + limited(step2, 31), slot);
    tables_.select(2, (limited(step1, 15) * 32 + limited(second, 15)) * 16 + limited(ahead, 7),
                   slot);
    tables_.select(3, limited(ahead, 31) * 16 + missClass(c), slot);
    tables_.select(4, limited(step1, 31) * 64 + limited(ahead, 31), slot);
    tables_.select(5, limited(second, 31) * 64 + limited(third, 31), slot);
    tables_.select(6, near * 16 + spreadClass, slot);
  }

  /// How far expectations were off at the neighbours.
  std::uint32_t missClass(std::uint32_t c) const {
    unsigned sum = 0;
    unsigned count = 0;
    for (const std::uint32_t rank : near_.ranks) {
      if (rank < points_.known) continue;
      sum += misses_[(rank - points_.known) * components_ + c];
      ++count;
    }
    return count > 0 ? std::min(halfOctave(2 * sum / count), 15U) : 0;
  }

  bool codeBit(unsigned slot, unsigned node, bool bit) {
    return codeMixed<kContexts>(coder_, logistic_, tables_.at(node),
                                mixers_[std::size_t{slot} * kNodes + node], bit);
  }

  /// A difference modulo 256: 0, −1, 1, −2, … by bit length and bits.
  int codeDifference(unsigned slot, int difference) {
    const auto wrapped = static_cast<unsigned>(difference) & 0xFFU;
    const unsigned folded = wrapped < 128 ? 2 * wrapped : 2 * (255 - wrapped) + 1;
    const unsigned length = entropy::bitLength(folded);
    unsigned coded = 0;
    while (coded < 8 && !codeBit(slot, coded, length == coded)) ++coded;
    unsigned value = coded > 0 ? 1 : 0;
    for (unsigned bit = coded > 0 ? coded - 1 : 0; bit-- > 0;) {
      // The first three bits by what stands before them, the others by their place.
      const unsigned node = bit + 4 >= coded ? 8 + coded * 16 + value : 152 + coded * 8 + bit;
      value = 2 * value + (codeBit(slot, node, ((folded >> bit) & 1) != 0) ? 1U : 0U);
    }
    return (value & 1) != 0 ? 255 - static_cast<int>(value / 2) : static_cast<int>(value / 2);
  }

  Coder& coder_;
  const RankedPoints& points_;
  const NeighbourTable& neighbours_;
  std::uint32_t components_;
  std::vector<std::uint8_t>& values_;
  PredictionWeights weights_;
  const LogisticTables& logistic_ = LogisticTables::instance();
  NodeTables tables_;
  std::vector<MixerWeights<kContexts>> mixers_;
  std::array<ErrorRegression, kSlots> regressions_{};
  std::vector<std::uint8_t> misses_;
  WeightedNeighbours near_;
};

}  // namespace

Bytes writeMixed(const RankedPoints& points, const NeighbourTable& neighbours,
                 std::uint32_t components, std::vector<std::uint8_t>& values, std::size_t limit) {
  entropy::SymbolWriter writer;
  MixingCoder<entropy::SymbolWriter>(writer, points, neighbours, components, values).run(limit);
  return writer.finish();
}

void readMixed(ByteView stream, const RankedPoints& points, const NeighbourTable& neighbours,
               std::uint32_t components, std::vector<std::uint8_t>& values) {
  entropy::SymbolReader reader(stream);
  MixingCoder<entropy::SymbolReader>(reader, points, neighbours, components, values)
      .run(points.size());
  reader.finish();
}

}  // namespace bspc::attributes
