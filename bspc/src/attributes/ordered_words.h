#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "bspc/scalar_type.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// How the bits of a number make it greater or smaller than another.
enum class NumberKind : std::uint8_t { Unsigned, Signed, Float };

constexpr NumberKind numberKind(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
    case ScalarType::Float64:
      return NumberKind::Float;
    case ScalarType::Int8:
    case ScalarType::Int16:
    case ScalarType::Int32:
    case ScalarType::Int64:
      return NumberKind::Signed;
    default:
      return NumberKind::Unsigned;
  }
}

/// Bytes of a number in ArrayValues::numbers.
inline std::size_t numberSize(ScalarType type) {
  return type == ScalarType::Bit ? 1 : scalarSize(type);
}

// An ordered word is a number's bits as an unsigned integer that sorts as the numbers do: the sign
// bit of signed integers and of floats that are not negative is flipped, all bits of negative
// floats are. Every bit pattern has its own word, NaN and −0 too.

template <class Word>
constexpr Word kTopBit = static_cast<Word>(Word{1} << (8 * sizeof(Word) - 1));

template <class Word>
constexpr Word orderedWord(Word bits, NumberKind kind) {
  if (kind == NumberKind::Unsigned) return bits;
  const bool all = kind == NumberKind::Float && (bits & kTopBit<Word>) != 0;
  return static_cast<Word>(bits ^ (all ? static_cast<Word>(~Word{0}) : kTopBit<Word>));
}

template <class Word>
constexpr Word bitsOfWord(Word word, NumberKind kind) {
  if (kind == NumberKind::Unsigned) return word;
  const bool all = kind == NumberKind::Float && (word & kTopBit<Word>) == 0;
  return static_cast<Word>(word ^ (all ? static_cast<Word>(~Word{0}) : kTopBit<Word>));
}

/// The word of the number 0.
template <class Word>
constexpr Word zeroWord(NumberKind kind) {
  return kind == NumberKind::Unsigned ? Word{0} : kTopBit<Word>;
}

/// The floating-point type of as many bits.
template <class Word>
using FloatOf = std::conditional_t<sizeof(Word) == 4, float, double>;

/// The number of a float's ordered word.
template <class Word>
double numberOfWord(Word word) {
  static_assert(sizeof(Word) >= 4);
  const Word bits = bitsOfWord(word, NumberKind::Float);
  FloatOf<Word> number = 0;
  std::memcpy(&number, &bits, sizeof bits);
  return static_cast<double>(number);
}

/// The ordered word of the float nearest to a number that its type can hold.
template <class Word>
Word wordOfNumber(double number) {
  static_assert(sizeof(Word) >= 4);
  const auto rounded = static_cast<FloatOf<Word>>(number);
  Word bits = 0;
  std::memcpy(&bits, &rounded, sizeof bits);
  return orderedWord(bits, NumberKind::Float);
}

/// Ordered words of packed tuples, those of the points sequence[0], sequence[1], …
template <class Word>
std::vector<Word> wordsOf(const std::uint8_t* numbers, NumberKind kind, std::size_t components,
                          Span<const std::uint32_t> sequence) {
  std::vector<Word> words(sequence.size() * components);
  Word* out = words.data();
  for (const std::uint32_t index : sequence) {
    const std::uint8_t* tuple = numbers + std::size_t{index} * components * sizeof(Word);
    for (std::size_t c = 0; c < components; ++c) {
      Word bits = 0;
      std::memcpy(&bits, tuple + c * sizeof(Word), sizeof(Word));
      *out++ = orderedWord(bits, kind);
    }
  }
  return words;
}

/// The inverse: fills in the tuples of sequence[first], sequence[first + 1], …
template <class Word>
void storeWords(const std::vector<Word>& words, NumberKind kind, std::size_t components,
                Span<const std::uint32_t> sequence, std::size_t first, std::uint8_t* numbers) {
  const Word* in = words.data() + first * components;
  for (std::size_t i = first; i < sequence.size(); ++i) {
    std::uint8_t* tuple = numbers + std::size_t{sequence[i]} * components * sizeof(Word);
    for (std::size_t c = 0; c < components; ++c) {
      const Word bits = bitsOfWord(*in++, kind);
      std::memcpy(tuple + c * sizeof(Word), &bits, sizeof(Word));
    }
  }
}

}  // namespace bspc::attributes
