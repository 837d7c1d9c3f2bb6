#include "attributes/category_coder.h"

#include <algorithm>
#include <array>
#include <string>

#include "attributes/logistic_mixer.h"
#include "attributes/residual_models.h"
#include "bspc/error.h"
#include "entropy/symbol_coder.h"

namespace bspc::attributes {

namespace {

constexpr unsigned kContexts = 3;

template <class Coder>
class CategoryCoder {
 public:
  CategoryCoder(Coder& coder, const CategoryAlphabet& alphabet, CategoryColumn& column)
      : coder_(coder),
        alphabet_(alphabet),
        column_(column),
        treeBits_(entropy::bitLength(std::max(alphabet.symbols(), 1U) - 1)),
        mixers_((std::size_t{kSlots} * kEqualities) << treeBits_,
                MixerWeights<kContexts>(kStartWeight)) {
    const std::uint64_t values = (column.end - column.first) * std::uint64_t{column.components};
    const unsigned bits = std::clamp(entropy::bitLength(values) + 3, kLeastTableBits, kTableBits);
    shift_ = 32 - bits;
    for (auto& table : tables_) table.resize(std::size_t{1} << bits);
  }

  void run(std::uint64_t maxEscaped) {
    std::size_t nextEscaped = 0;
    for (std::size_t place = column_.first; place < column_.end; ++place) {
      for (std::uint32_t c = 0; c < column_.components; ++c) {
        if (!codeSymbol(place, c)) continue;
        if (!Coder::kWriting) {
          if (column_.escaped.size() >= maxEscaped) {
            throw Error(ErrorCode::LimitExceeded,
                        "decoding an array needs more memory than the limit; raise the limit if "
                        "the file is to be trusted");
          }
          column_.escaped.push_back(0);
        }
        std::uint64_t& word = column_.escaped[nextEscaped++];
        word = coder_.wide(word, alphabet_.wordBits);
      }
    }
  }

 private:
  static constexpr unsigned kLeastTableBits = 10;
  static constexpr unsigned kTableBits = 18;
  static constexpr unsigned kEqualities = 4;  ///< whether the first symbol equals the other two
  static constexpr std::int32_t kStartWeight = 22000;

  /// The symbols of the tuples that are looked at; where there are fewer, the last one again.
  std::array<std::uint32_t, kContexts> contextSymbols(std::size_t place, std::uint32_t c) const {
    std::array<std::uint32_t, kContexts> result{};
    Span<const std::uint32_t> near;
    std::size_t count = std::min<std::size_t>(place - column_.first, kContexts);
    if (column_.neighbours != nullptr) {
      near = column_.neighbours->of(place);
      count = std::min<std::size_t>(near.size(), kContexts);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t other = column_.neighbours != nullptr ? near[i] : place - 1 - i;
      result[i] = column_.symbols[other * column_.components + c];
    }
    for (std::size_t i = std::max<std::size_t>(count, 1); i < kContexts; ++i) {
      result[i] = result[i - 1];
    }
    return result;
  }

  static std::uint32_t hashOf(std::uint32_t v) {
    v ^= v >> 15;
    v *= 0x2C1B3C6DU;
    return v ^ (v >> 13);
  }

  /// True for an escape.
  bool codeSymbol(std::size_t place, std::uint32_t c) {
    const auto near = contextSymbols(place, c);
    const std::uint32_t slot = std::min(c, kSlots - 1);
    const std::array<std::uint32_t, kContexts> hashes{
        hashOf(slot * 256 + near[0]), hashOf((slot * 256 + near[0]) * 256 + near[1] + 0x40000000U),
        hashOf(near[0] * 0x9E3779B1U ^ near[1] * 0x85EBCA6BU ^ near[2] * 0xC2B2AE35U ^
               slot * 0x27D4EB2FU)};
    const unsigned equality = (near[0] == near[1] ? 1U : 0U) + (near[0] == near[2] ? 2U : 0U);
    MixerWeights<kContexts>* mixers =
        mixers_.data() + ((std::size_t{slot} * kEqualities + equality) << treeBits_);
    std::uint8_t& symbol = column_.symbols[place * column_.components + c];
    unsigned node = 1;
    for (unsigned bit = treeBits_; bit-- > 0;) {
      std::array<ContextBit*, kContexts> bits;
      for (unsigned i = 0; i < kContexts; ++i) {
        const std::uint32_t hash = (hashes[i] + node * 0x9E3779B1U) * 0x85EBCA6BU;
        bits[i] = &tables_[i][hash >> shift_];
      }
      const bool one = codeMixed<kContexts>(coder_, logistic_, bits, mixers[node],
                                            ((unsigned{symbol} >> bit) & 1) != 0);
      node = 2 * node + (one ? 1U : 0U);
    }
    const unsigned coded = node - (1U << treeBits_);
    if (coded >= alphabet_.symbols()) {
      throw Error(ErrorCode::Corrupt,
                  "a category of an array has the number " + std::to_string(coded) + ", of " +
                      std::to_string(alphabet_.symbols()) + ": the file is damaged");
    }
    symbol = static_cast<std::uint8_t>(coded);
    return coded == alphabet_.words.size();
  }

  Coder& coder_;
  const CategoryAlphabet& alphabet_;
  CategoryColumn& column_;
  unsigned treeBits_;
  unsigned shift_ = 0;  ///< from hashes to places in the tables
  const LogisticTables& logistic_ = LogisticTables::instance();
  std::array<std::vector<ContextBit>, kContexts> tables_;
  std::vector<MixerWeights<kContexts>> mixers_;
};

}  // namespace

Bytes writeCategories(const CategoryAlphabet& alphabet, CategoryColumn& column) {
  entropy::SymbolWriter writer;
  CategoryCoder<entropy::SymbolWriter>(writer, alphabet, column).run(column.escaped.size());
  return writer.finish();
}

void readCategories(ByteView stream, const CategoryAlphabet& alphabet, std::uint64_t maxEscaped,
                    CategoryColumn& column) {
  entropy::SymbolReader reader(stream);
  CategoryCoder<entropy::SymbolReader>(reader, alphabet, column).run(maxEscaped);
  reader.finish();
}

}  // namespace bspc::attributes
