#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "bspc/arrays.h"

namespace bspc::test {

/// An array of random values of any type; about half of them are one of few, as real ones are.
inline ArrayValues randomArray(const std::string& name, ScalarType type, std::uint32_t components,
                               std::size_t tuples, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ArrayValues array;
  array.name = name;
  array.type = type;
  array.components = components;
  const std::size_t count = tuples * components;
  const std::size_t size = arrayValueSize(type);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t bits = random();
    if (bits % 2 == 0) bits = bits >> 8 & 3;
    if (type == ScalarType::String) {
      array.strings.push_back(bits % 5 == 0 ? std::string() : "text " + std::to_string(bits));
      continue;
    }
    if (type == ScalarType::Bit) bits &= 1;
    for (std::size_t b = 0; b < size; ++b) {
      array.values.push_back(static_cast<std::uint8_t>(bits >> (8 * b)));
    }
  }
  return array;
}

/// One array of every type, with one to four components.
inline std::vector<ArrayValues> arraysOfAllTypes(std::size_t tuples) {
  std::vector<ArrayValues> arrays;
  for (unsigned t = 0; t <= static_cast<unsigned>(ScalarType::String); ++t) {
    const auto type = static_cast<ScalarType>(t);
    arrays.push_back(randomArray(scalarName(type), type, 1 + t % 4, tuples, t + 1));
  }
  return arrays;
}

/// Tuple i of an array, as bytes or joined strings.
inline std::string tupleOf(const ArrayValues& array, std::size_t i) {
  std::string tuple;
  if (array.type == ScalarType::String) {
    for (std::size_t c = 0; c < array.components; ++c) {
      tuple += array.strings[i * array.components + c] + "|";
    }
    return tuple;
  }
  const std::size_t size = array.components * arrayValueSize(array.type);
  return {array.values.begin() + static_cast<std::ptrdiff_t>(i * size),
          array.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * size)};
}

/// Tuple i of each of them, joined.
inline std::string tuplesOf(const std::vector<ArrayValues>& arrays, std::size_t i) {
  std::string tuples;
  for (const ArrayValues& array : arrays) tuples += tupleOf(array, i);
  return tuples;
}

}  // namespace bspc::test
