#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bspc::attributes {

/// Replaces the words of each tuple but the first by their differences from those of the tuple
/// before, modulo 2^bits.
template <class Word>
void toDifferences(std::vector<Word>& words, std::size_t components) {
  for (std::size_t i = words.size(); i-- > components;) {
    words[i] = static_cast<Word>(words[i] - words[i - components]);
  }
}

/// The inverse.
template <class Word>
void fromDifferences(std::vector<Word>& words, std::size_t components) {
  for (std::size_t i = components; i < words.size(); ++i) {
    words[i] = static_cast<Word>(words[i] + words[i - components]);
  }
}

/// The words' bytes: by tuples, or, as planes, the first byte of all tuples, then the second, ….
template <class Word>
std::vector<std::uint8_t> bytesOf(const std::vector<Word>& words, std::size_t components,
                                  bool planes) {
  const std::size_t tupleSize = components * sizeof(Word);
  const std::size_t count = words.size() / components;
  std::vector<std::uint8_t> bytes(words.size() * sizeof(Word));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t tuple = i / components;
    const std::size_t first = (i % components) * sizeof(Word);
    for (std::size_t b = 0; b < sizeof(Word); ++b) {
      const std::size_t at = planes ? (first + b) * count + tuple : tuple * tupleSize + first + b;
      bytes[at] = static_cast<std::uint8_t>(std::uint64_t{words[i]} >> (8 * b));
    }
  }
  return bytes;
}

/// The inverse; `words` has its size.
template <class Word>
void wordsFromBytes(const std::vector<std::uint8_t>& bytes, std::size_t components, bool planes,
                    std::vector<Word>& words) {
  const std::size_t tupleSize = components * sizeof(Word);
  const std::size_t count = words.size() / components;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t tuple = i / components;
    const std::size_t first = (i % components) * sizeof(Word);
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < sizeof(Word); ++b) {
      const std::size_t at = planes ? (first + b) * count + tuple : tuple * tupleSize + first + b;
      word |= std::uint64_t{bytes[at]} << (8 * b);
    }
    words[i] = static_cast<Word>(word);
  }
}

}  // namespace bspc::attributes
