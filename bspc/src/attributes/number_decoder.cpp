#include <algorithm>
#include <cstring>
#include <string>

#include "attributes/mixing_coder.h"
#include "attributes/number_coder.h"
#include "attributes/sequence_words.h"
#include "attributes/word_alphabet.h"
#include "bspc/error.h"

namespace bspc::attributes {

namespace {

template <class Word>
class NumberDecoder {
 public:
  NumberDecoder(const NumberShape& shape, container::ByteReader& in, TilePoints& points,
                MemoryBudget& budget, Bytes& numbers)
      : shape_(shape),
        kind_(numberKind(shape.type)),
        in_(in),
        points_(points),
        budget_(budget),
        numbers_(numbers) {}

  void decode() {
    switch (readMethod(in_)) {
      case ArrayMethod::Constant:
        return decodeConstant();
      case ArrayMethod::Bytes:
        return decodeBytes();
      case ArrayMethod::Quick:
        return decodeQuick();
      case ArrayMethod::Residual:
        return decodeResiduals();
      case ArrayMethod::Mixing:
        return decodeMixed();
      case ArrayMethod::Categories:
        return decodeCategories();
      default:
        in_.fail("the method is not one for numbers");
    }
  }

 private:
  std::size_t newWords() const { return points_.added() * shape_.components; }

  void decodeConstant() {
    const std::size_t size = shape_.components * sizeof(Word);
    const ByteView tuple = in_.bytes(size);
    for (std::size_t i = points_.known(); i < points_.size(); ++i) {
      std::copy(tuple.begin(), tuple.end(), numbers_.data() + i * size);
    }
  }

  Span<const std::uint32_t> sequence(bool inputOrder) {
    if (!inputOrder) return points_.decodedSequence(budget_);
    if (!points_.hasInputOrder()) {
      in_.fail("the array follows the order of the input, which is not known here");
    }
    return points_.inputSequence();
  }

  void decodeBytes() {
    const BytesSettings settings = readBytesSettings(in_);
    budget_.take(newWords(), 2 * sizeof(Word));
    std::vector<Word> words(newWords());
    Bytes bytes(words.size() * sizeof(Word));
    PlaneReader reader;
    const std::size_t rows = settings.planes ? shape_.components * sizeof(Word) : 1;
    const std::size_t length = bytes.size() / rows;
    for (std::size_t r = 0; r < rows; ++r) {
      reader.read(in_, Span<std::uint8_t>(bytes.data() + r * length, length));
    }
    wordsFromBytes(bytes, shape_.components, settings.planes, words);
    if (settings.delta) fromDifferences(words, shape_.components);
    storeWords(words, kind_, shape_.components, sequence(settings.inputOrder), 0, numbers_.data());
  }

  void decodeQuick() {
    const QuickSettings settings = readQuickSettings(in_, shape_);
    const WindowTable& window = points_.window(budget_);
    budget_.take(newWords(), 2 * sizeof(Word));
    std::vector<Word> words(newWords());
    readQuick(in_, window, settings, words);
    storeWords(words, kind_, shape_.components, points_.decodedSequence(budget_), 0,
               numbers_.data());
  }

  std::vector<Word> rankedWords(const RankedPoints& ranked) {
    budget_.take(numbers_.size());
    return wordsOf<Word>(numbers_.data(), kind_, shape_.components, ranked.indexOfRank);
  }
  void storeRanked(const RankedPoints& ranked, const std::vector<Word>& words) {
    storeWords(words, kind_, shape_.components, Span<const std::uint32_t>(ranked.indexOfRank),
               points_.known(), numbers_.data());
  }

  void decodeResiduals() {
    const ResidualSettings settings = readResidualSettings(in_, shape_);
    const NeighbourTable& near = points_.neighbours(neighboursOf(settings.predictor), budget_);
    const RankedPoints& ranked = points_.ranked(budget_);
    std::vector<Word> words = rankedWords(ranked);
    constexpr std::uint64_t kDirection = 12;
    budget_.take(points_.size(), kDirection + shape_.components * (sizeof(Word) + 1ULL));
    readResiduals(in_.bytes(in_.remaining()), ranked, near, settings, words);
    storeRanked(ranked, words);
  }

  void decodeMixed() {
    std::vector<Word> distinct;
    if (sizeof(Word) > 1) distinct = readDistinct<Word>(in_);
    const NeighbourTable& near = points_.neighbours(neighboursOf(Predictor::MeanOf8), budget_);
    const RankedPoints& ranked = points_.ranked(budget_);
    std::vector<Word> words = rankedWords(ranked);
    budget_.take(words.size(), 2);
    std::vector<std::uint8_t> values(words.size());
    const std::size_t known = points_.known() * shape_.components;
    for (std::size_t i = 0; i < known; ++i) {
      values[i] =
          distinct.empty() ? static_cast<std::uint8_t>(words[i]) : indexOfWord(distinct, words[i]);
    }
    readMixed(in_.bytes(in_.remaining()), ranked, near, shape_.components, values);
    for (std::size_t i = known; i < values.size(); ++i) {
      if (distinct.empty()) {
        words[i] = static_cast<Word>(values[i]);
      } else if (values[i] < distinct.size()) {
        words[i] = distinct[values[i]];
      } else {
        in_.fail("a value of an array has the number " + std::to_string(values[i]) + " of " +
                 std::to_string(distinct.size()));
      }
    }
    storeRanked(ranked, words);
  }

  CategoryAlphabet readAlphabet(bool escapes) {
    CategoryAlphabet alphabet;
    alphabet.wordBits = 8 * sizeof(Word);
    alphabet.escapes = escapes;
    alphabet.words.resize(in_.u8());
    for (std::uint64_t& word : alphabet.words) word = in_.unsignedLittle(sizeof(Word));
    return alphabet;
  }

  void decodeCategories() {
    bool escapes = false;
    const CategorySettings settings = readCategorySettings(in_, escapes);
    const CategoryAlphabet alphabet = readAlphabet(escapes);
    CategoryColumn column;
    column.components = shape_.components;
    if (settings.inputOrder) {
      const Span<const std::uint32_t> order = sequence(true);
      budget_.take(newWords(), 1 + sizeof(Word));
      column.symbols.resize(newWords());
      column.end = points_.added();
      readCategories(in_.bytes(in_.remaining()), alphabet, budget_.left() / 16, column);
      std::vector<Word> words(newWords());
      restore(alphabet, column, 0, words);
      if (settings.delta) fromDifferences(words, shape_.components);
      storeWords(words, kind_, shape_.components, order, 0, numbers_.data());
      return;
    }
    column.neighbours = &points_.neighbours(neighboursOf(Predictor::MeanOf3), budget_);
    const RankedPoints& ranked = points_.ranked(budget_);
    std::vector<Word> words = rankedWords(ranked);
    budget_.take(words.size());
    column.symbols.resize(words.size());
    column.first = points_.known();
    column.end = points_.size();
    const std::size_t known = points_.known() * shape_.components;
    for (std::size_t i = 0; i < known; ++i) {
      column.symbols[i] = alphabet.symbolOf(words[i]);
    }
    readCategories(in_.bytes(in_.remaining()), alphabet, budget_.left() / 16, column);
    restore(alphabet, column, known, words);
    storeRanked(ranked, words);
  }

  static void restore(const CategoryAlphabet& alphabet, const CategoryColumn& column,
                      std::size_t first, std::vector<Word>& words) {
    std::size_t escaped = 0;
    for (std::size_t i = first; i < words.size(); ++i) {
      const std::uint8_t symbol = column.symbols[i];
      words[i] = static_cast<Word>(symbol < alphabet.words.size() ? alphabet.words[symbol]
                                                                  : column.escaped[escaped++]);
    }
  }

  const NumberShape& shape_;
  NumberKind kind_;
  container::ByteReader& in_;
  TilePoints& points_;
  MemoryBudget& budget_;
  Bytes& numbers_;
};

}  // namespace

void decodeNumbers(const NumberShape& shape, container::ByteReader& in, TilePoints& points,
                   MemoryBudget& budget, Bytes& numbers) {
  withWord(numberSize(shape.type), [&](auto word) {
    NumberDecoder<decltype(word)>(shape, in, points, budget, numbers).decode();
  });
}

}  // namespace bspc::attributes
