#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

#include "attributes/method_choice.h"
#include "attributes/mixing_coder.h"
#include "attributes/number_coder.h"
#include "attributes/sequence_words.h"
#include "attributes/word_alphabet.h"

namespace bspc::attributes {

namespace {

/// Efforts from this one on use exact neighbours and the range coder.
constexpr unsigned kFullEffort = 5;
/// Categories along the input need no neighbours: they are quick enough from here on.
constexpr unsigned kInputCategoriesEffort = 2;

int zstdLevel(unsigned effort) {
  constexpr std::array<int, 10> kLevels{1, 1, 1, 3, 6, 9, 12, 15, 19, 19};
  return kLevels[std::min<std::size_t>(effort, kLevels.size() - 1)];
}

/// Ways that are compared with each other first.
enum Family : std::uint8_t {
  kBytesFamily,
  kInputBytesFamily,
  kQuickFamily,
  kResidualFamily,
  kMixingFamily,
  kSpatialFamily,
  kInputFamily
};

template <class Word>
class NumberEncoder {
 public:
  NumberEncoder(const NumberShape& shape, const Bytes& numbers, TilePoints& points, unsigned effort)
      : shape_(shape),
        kind_(numberKind(shape.type)),
        numbers_(numbers),
        points_(points),
        effort_(effort),
        planes_(zstdLevel(effort)) {}

  Bytes encode() {
    if (isConstant()) return writeConstant();
    addBytes();
    addQuick();
    if (effort_ >= kFullEffort) {
      addResiduals();
      addMixing();
      addSpatialCategories();
    }
    if (effort_ >= kInputCategoriesEffort) addInputCategories();
    const bool quick = effort_ < kFullEffort;
    return smallestPayload(candidates_, points_.added(), quick ? kQuickSample : kFullSample, quick);
  }

 private:
  static constexpr std::size_t kQuickSample = 4096;
  static constexpr std::size_t kFullSample = 16384;

  std::size_t tupleSize() const { return shape_.components * sizeof(Word); }
  std::size_t wordsUpTo(std::size_t limit) const {
    return std::min(limit, points_.added()) * shape_.components;
  }

  bool isConstant() const {
    const std::uint8_t* first = numbers_.data() + points_.known() * tupleSize();
    const std::size_t rest = (points_.added() - 1) * tupleSize();
    return std::memcmp(first, first + tupleSize(), rest) == 0;
  }

  Bytes writeConstant() const {
    container::ByteWriter out;
    writeMethod(ArrayMethod::Constant, out);
    out.bytes({numbers_.data() + points_.known() * tupleSize(), tupleSize()});
    return out.take();
  }

  std::vector<Word> gathered(Span<const std::uint32_t> sequence) const {
    return wordsOf<Word>(numbers_.data(), kind_, shape_.components, sequence);
  }
  const std::vector<Word>& decodedWords() {
    if (decoded_.empty()) decoded_ = gathered(points_.decodedSequence(budget_));
    return decoded_;
  }
  const std::vector<Word>& inputWords() {
    if (input_.empty()) input_ = gathered(points_.inputSequence());
    return input_;
  }
  std::vector<Word>& rankedWords() {
    if (ranked_.empty()) ranked_ = gathered(points_.ranked(budget_).indexOfRank);
    return ranked_;
  }

  void add(Family family, double learning, std::size_t fixedBytes,
           std::function<Bytes(std::size_t)> write) {
    candidates_.push_back({std::move(write), fixedBytes, learning, family});
  }

  // Method Bytes.

  void addBytes() {
    for (const bool inputOrder : {false, true}) {
      if (inputOrder && !points_.hasInputOrder()) continue;
      for (const bool delta : {false, true}) {
        for (const bool planes : {true, false}) {
          if (!planes && (tupleSize() == 1 || (effort_ < kFullEffort && delta))) continue;
          const BytesSettings settings{inputOrder, delta, planes};
          add(kBytesFamily, 1, 0,
              [this, settings](std::size_t limit) { return writeBytes(settings, limit); });
        }
      }
    }
  }

  Bytes writeBytes(const BytesSettings& settings, std::size_t limit) {
    const std::vector<Word>& all = settings.inputOrder ? inputWords() : decodedWords();
    std::vector<Word> words(all.begin(),
                            all.begin() + static_cast<std::ptrdiff_t>(wordsUpTo(limit)));
    if (settings.delta) toDifferences(words, shape_.components);
    const Bytes bytes = bytesOf(words, shape_.components, settings.planes);
    container::ByteWriter out;
    writeMethod(ArrayMethod::Bytes, out);
    out.u8(packed(settings));
    const std::size_t rows = settings.planes ? tupleSize() : 1;
    const std::size_t length = bytes.size() / rows;
    for (std::size_t r = 0; r < rows; ++r) {
      planes_.write({bytes.data() + r * length, length}, out);
    }
    return out.take();
  }

  // Method Quick.

  void addQuick() {
    using Domain = QuickSettings::Domain;
    for (const Domain domain : {Domain::Words, Domain::Numbers, Domain::Unit}) {
      if (!allows(shape_, domain)) continue;
      if (domain == Domain::Words && isFloatingPoint(shape_.type)) continue;
      if (domain == Domain::Unit && !looksUnit()) continue;
      for (const bool mean : {false, true}) {
        for (const bool chained : {false, true}) {
          if (chained && (shape_.components == 1 || domain != Domain::Words)) continue;
          QuickSettings settings = quickSettings(shape_);
          settings.domain = domain;
          settings.mean = mean;
          settings.chained = chained;
          add(kQuickFamily, 1, 0,
              [this, settings](std::size_t limit) { return writeQuickly(settings, limit); });
        }
      }
    }
  }

  Bytes writeQuickly(const QuickSettings& settings, std::size_t limit) {
    container::ByteWriter out;
    writeMethod(ArrayMethod::Quick, out);
    out.u8(packed(settings));
    writeQuick(points_.window(budget_), settings, decodedWords(), limit, planes_, out);
    return out.take();
  }

  /// Whether the squares of a tuple's numbers sum up to one, for most of some tuples.
  bool looksUnit() {
    if constexpr (sizeof(Word) < 4) {
      return false;
    } else {
      constexpr std::size_t kTried = 64;
      constexpr double kTolerance = 1e-3;
      const std::vector<Word>& words = decodedWords();
      const std::size_t count = words.size() / 3;
      const std::size_t step = std::max<std::size_t>(count / kTried, 1);
      std::size_t tried = 0;
      std::size_t unit = 0;
      for (std::size_t i = 0; i < count; i += step, ++tried) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const double number = numberOfWord(words[3 * i + c]);
          sum += number * number;
        }
        if (std::fabs(sum - 1) < kTolerance) ++unit;
      }
      return 2 * unit > tried;
    }
  }

  // Method Residual.

  void addResiduals() {
    using Domain = ResidualSettings::Domain;
    Domain domain = isFloatingPoint(shape_.type) ? Domain::Numbers : Domain::Words;
    if (shape_.sphereHalf > 0) domain = Domain::Sphere;
    if (isFloatingPoint(shape_.type) && shape_.components == 3 && looksUnit()) {
      domain = Domain::Unit;
    }
    addPredictor(domain, Predictor::Nearest, 0);
    addPredictor(domain, Predictor::MeanOf3, 0);
    addPredictor(domain, Predictor::MeanOf8, 0);
    constexpr unsigned kAllStiffnesses = 7;
    constexpr unsigned kQuadrics = 8;
    for (unsigned stiffness = 0; stiffness < kStiffnesses; ++stiffness) {
      if (effort_ < kAllStiffnesses && stiffness % 2 == 1) continue;
      addPredictor(domain, Predictor::PlaneOver8, stiffness);
      if (effort_ >= kQuadrics && stiffness > 0) {
        addPredictor(domain, Predictor::QuadricOver20, stiffness);
      }
    }
  }

  void addPredictor(ResidualSettings::Domain domain, Predictor predictor, unsigned stiffness) {
    ResidualSettings settings = residualSettings(shape_);
    settings.domain = domain;
    settings.predictor = predictor;
    settings.stiffness = stiffness;
    add(kResidualFamily, 1, 0, [this, settings](std::size_t limit) {
      container::ByteWriter out;
      writeMethod(ArrayMethod::Residual, out);
      out.u8(packed(settings));
      const NeighbourTable& near = points_.neighbours(neighboursOf(settings.predictor), budget_);
      out.bytes(writeResiduals(points_.ranked(budget_), near, settings, rankedWords(), limit));
      return out.take();
    });
  }

  // Method Mixing.

  void addMixing() {
    constexpr double kLearning = 0.9;
    std::vector<Word> distinct;
    if (sizeof(Word) > 1) {
      distinct = distinctWords(decodedWords());
      if (distinct.empty()) return;
    }
    container::ByteWriter head;
    writeMethod(ArrayMethod::Mixing, head);
    if (!distinct.empty()) writeDistinct(distinct, head);
    add(kMixingFamily, kLearning, head.size(),
        [this, distinct, start = head.data()](std::size_t limit) {
          const std::vector<Word>& words = rankedWords();
          std::vector<std::uint8_t> values(words.size());
          for (std::size_t i = 0; i < words.size(); ++i) {
            values[i] = distinct.empty() ? static_cast<std::uint8_t>(words[i])
                                         : indexOfWord(distinct, words[i]);
          }
          container::ByteWriter out;
          out.bytes(start);
          out.bytes(writeMixed(points_.ranked(budget_),
                               points_.neighbours(neighboursOf(Predictor::MeanOf8), budget_),
                               shape_.components, values, limit));
          return out.take();
        });
  }

  // Method Categories.

  /// Escapes cost as much as plain words; an alphabet is of use if they are not too many.
  static bool assign(const CategoryAlphabet& alphabet, const std::vector<Word>& words,
                     std::vector<std::uint64_t>& escaped, std::vector<std::uint8_t>& symbols) {
    symbols.resize(words.size());
    std::vector<std::pair<std::uint64_t, std::uint8_t>> index;
    for (std::size_t s = 0; s < alphabet.words.size(); ++s) {
      index.emplace_back(alphabet.words[s], static_cast<std::uint8_t>(s));
    }
    std::sort(index.begin(), index.end());
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto at =
          std::lower_bound(index.begin(), index.end(),
                           std::pair<std::uint64_t, std::uint8_t>{words[i], std::uint8_t{0}});
      if (at != index.end() && at->first == words[i]) {
        symbols[i] = at->second;
      } else {
        symbols[i] = static_cast<std::uint8_t>(alphabet.words.size());
        escaped.push_back(words[i]);
      }
    }
    return escaped.size() < words.size() / 2;
  }

  void addCategories(const CategorySettings& settings, const CategoryAlphabet& alphabet,
                     CategoryColumn column) {
    constexpr double kLearning = 0.95;
    // A sample along the input has other points than one along the curve: it does not tell.
    constexpr double kElsewhere = 0;
    container::ByteWriter head;
    writeMethod(ArrayMethod::Categories, head);
    head.u8(packed(settings, alphabet.escapes));
    head.u8(static_cast<unsigned>(alphabet.words.size()));
    for (const std::uint64_t word : alphabet.words) head.unsignedLittle(word, sizeof(Word));
    add(settings.inputOrder ? kInputFamily : kSpatialFamily,
        settings.inputOrder ? kElsewhere : kLearning, head.size(),
        [this, alphabet, column = std::move(column), start = head.data()](std::size_t limit) {
          CategoryColumn part = column;
          part.end = part.first + std::min(limit, points_.added());
          container::ByteWriter out;
          out.bytes(start);
          out.bytes(writeCategories(alphabet, part));
          return out.take();
        });
  }

  void addSpatialCategories() {
    const CategoryAlphabet alphabet = categoryAlphabet(decodedWords());
    if (alphabet.escapes) return;
    const std::vector<Word>& words = rankedWords();
    CategoryColumn column;
    column.components = shape_.components;
    column.first = points_.known();
    column.neighbours = &points_.neighbours(neighboursOf(Predictor::MeanOf3), budget_);
    std::vector<std::uint64_t> unknown;  // words of known points may have no symbol
    assign(alphabet, words, unknown, column.symbols);
    addCategories({false, false}, alphabet, std::move(column));
  }

  /// Whether few values make up three quarters of a sample: in most arrays they do not, and
  /// counting all of theirs would cost more than coding them quickly.
  static bool looksLikeCategories(const std::vector<Word>& words) {
    constexpr std::size_t kFew = 16;
    const std::size_t count = std::min(words.size(), kQuickSample);
    const auto first = words.begin() + static_cast<std::ptrdiff_t>((words.size() - count) / 2);
    std::vector<Word> sorted(first, first + static_cast<std::ptrdiff_t>(count));
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::size_t> runs;
    for (std::size_t i = 0; i < count;) {
      const std::size_t start = i;
      while (i < count && sorted[i] == sorted[start]) ++i;
      runs.push_back(i - start);
    }
    std::sort(runs.begin(), runs.end(), std::greater<>());
    runs.resize(std::min(runs.size(), kFew));
    return 4 * std::accumulate(runs.begin(), runs.end(), std::size_t{0}) > 3 * count;
  }

  void addInputCategories() {
    const bool quick = effort_ < kFullEffort;
    if (!points_.hasInputOrder() || (quick && shape_.components > 1)) return;
    for (const bool delta : {false, true}) {
      std::vector<Word> words = inputWords();
      if (delta) toDifferences(words, shape_.components);
      if (quick && !looksLikeCategories(words)) continue;
      const CategoryAlphabet alphabet = categoryAlphabet(words);
      CategoryColumn column;
      column.components = shape_.components;
      if (!assign(alphabet, words, column.escaped, column.symbols)) continue;
      addCategories({true, delta}, alphabet, std::move(column));
    }
  }

  const NumberShape& shape_;
  NumberKind kind_;
  const Bytes& numbers_;
  TilePoints& points_;
  unsigned effort_;
  MemoryBudget budget_ = MemoryBudget::unlimited();
  PlaneWriter planes_;
  std::vector<Word> decoded_;
  std::vector<Word> input_;
  std::vector<Word> ranked_;
  std::vector<Candidate> candidates_;
};

}  // namespace

bool followsInput(ByteView payload) {
  constexpr std::size_t kSettings = 1;
  if (payload.size() <= kSettings) return false;
  const auto method = static_cast<ArrayMethod>(payload[0]);
  return (method == ArrayMethod::Bytes || method == ArrayMethod::Categories) &&
         (payload[kSettings] & 1) != 0;
}

Bytes encodeNumbers(const NumberShape& shape, const Bytes& numbers, TilePoints& points,
                    unsigned effort) {
  return withWord(numberSize(shape.type), [&](auto word) {
    return NumberEncoder<decltype(word)>(shape, numbers, points, effort).encode();
  });
}

}  // namespace bspc::attributes
