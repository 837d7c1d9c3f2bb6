#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "attributes/neighbours.h"
#include "bspc/span.h"

namespace bspc::attributes {

// Method categories: few values that say what a point is (labels, return numbers), coded by those
// of the nearest points or of the points before in the order of the input.

/// The words that have symbols of their own; others are escapes.
struct CategoryAlphabet {
  static constexpr unsigned kMaxWords = 255;

  std::vector<std::uint64_t> words;
  unsigned wordBits = 8;
  bool escapes = false;  ///< whether the symbol words.size() occurs, a word in raw bits behind it

  unsigned symbols() const { return static_cast<unsigned>(words.size()) + (escapes ? 1U : 0U); }

  /// The symbol of a word; words.size() if it has none.
  std::uint8_t symbolOf(std::uint64_t word) const {
    const auto at = std::find(words.begin(), words.end(), word);
    return static_cast<std::uint8_t>(at - words.begin());
  }
};

/// Symbols of the new points, `components` a point, in the order in which they are coded. Contexts
/// are those of up to three tuples for each point: coded ones, or of known points.
struct CategoryColumn {
  std::uint32_t components = 1;
  /// By place: known points (spatial contexts only), then new ones.
  std::vector<std::uint8_t> symbols;
  std::vector<std::uint64_t> escaped;          ///< words of the escapes, in coded order
  std::size_t first = 0;                       ///< place of the first new point
  std::size_t end = 0;                         ///< behind the last one to be coded
  const NeighbourTable* neighbours = nullptr;  ///< null: the three places before
};

/// Codes the symbols of places first … end − 1.
Bytes writeCategories(const CategoryAlphabet& alphabet, CategoryColumn& column);

/// Fills in the symbols of places first … end − 1 and the escaped words, at most `maxEscaped`.
void readCategories(ByteView stream, const CategoryAlphabet& alphabet, std::uint64_t maxEscaped,
                    CategoryColumn& column);

}  // namespace bspc::attributes
