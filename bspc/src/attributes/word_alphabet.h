#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "attributes/category_coder.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::attributes {

/// The words that method Mixing numbers 0 … 255, ascending; empty if words are bytes themselves or
/// if there are more.
template <class Word>
std::vector<Word> distinctWords(const std::vector<Word>& words) {
  constexpr std::size_t kMost = 256;
  std::vector<Word> distinct;
  for (const Word word : words) {
    const auto at = std::lower_bound(distinct.begin(), distinct.end(), word);
    if (at != distinct.end() && *at == word) continue;
    if (distinct.size() == kMost) return {};
    distinct.insert(at, word);
  }
  return distinct;
}

/// The number of the first word that is not less, at most the last one's.
template <class Word>
std::uint8_t indexOfWord(const std::vector<Word>& distinct, Word word) {
  const auto at = std::lower_bound(distinct.begin(), distinct.end(), word);
  const auto index = static_cast<std::size_t>(at - distinct.begin());
  return static_cast<std::uint8_t>(std::min(index, distinct.size() - 1));
}

/// Their number minus one, the first, and the steps to the others minus one.
template <class Word>
void writeDistinct(const std::vector<Word>& distinct, container::ByteWriter& out) {
  out.u8(static_cast<unsigned>(distinct.size() - 1));
  out.varint(distinct[0]);
  for (std::size_t i = 1; i < distinct.size(); ++i) {
    out.varint(std::uint64_t{distinct[i]} - distinct[i - 1] - 1);
  }
}

template <class Word>
std::vector<Word> readDistinct(container::ByteReader& in) {
  std::vector<Word> distinct(in.u8() + std::size_t{1});
  std::uint64_t next = 0;
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    const std::uint64_t step = in.varint();
    const std::uint64_t word = next + step;
    if (word < next || word > static_cast<Word>(~Word{0}) || (i > 0 && next == 0)) {
      in.fail("the values of an array leave their type");
    }
    distinct[i] = static_cast<Word>(word);
    next = word + 1;
  }
  return distinct;
}

/// The words of method Categories, the most frequent first: all of them, or those that are worth a
/// symbol.
template <class Word>
CategoryAlphabet categoryAlphabet(std::vector<Word> words) {
  std::sort(words.begin(), words.end());
  std::vector<std::pair<std::size_t, Word>> counts;
  for (std::size_t i = 0; i < words.size();) {
    std::size_t end = i;
    while (end < words.size() && words[end] == words[i]) ++end;
    counts.emplace_back(end - i, words[i]);
    i = end;
  }
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  CategoryAlphabet alphabet;
  alphabet.wordBits = 8 * sizeof(Word);
  alphabet.escapes = counts.size() > CategoryAlphabet::kMaxWords;
  for (const auto& [count, word] : counts) {
    if (alphabet.words.size() == CategoryAlphabet::kMaxWords) break;
    if (alphabet.escapes && count == 1) break;
    alphabet.words.push_back(word);
  }
  return alphabet;
}

}  // namespace bspc::attributes
