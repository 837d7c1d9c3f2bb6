#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "attributes/array_coder.h"
#include "bspc/arrays.h"
#include "bspc/span.h"

namespace bspc {

/// Tuples of an array that are moved about as wholes.
class ArrayTuples {
 public:
  explicit ArrayTuples(const attributes::ArrayShape& shape)
      : strings_(shape.type == ScalarType::String),
        tuple_(shape.components * (strings_ ? 1 : arrayValueSize(shape.type))) {}

  /// Bytes that so many tuples take in memory, without the characters of strings.
  std::uint64_t bytes(std::uint64_t tuples) const {
    return tuples * tuple_ * (strings_ ? sizeof(std::string) : 1);
  }
  std::size_t count(const attributes::ArrayValues& values) const {
    return (strings_ ? values.strings.size() : values.numbers.size()) / tuple_;
  }
  /// Appends the tuples first … first + count − 1 of `from`.
  void append(attributes::ArrayValues& to, const attributes::ArrayValues& from, std::size_t first,
              std::size_t count) const;
  /// Tuple i of `values` becomes tuple places[i]; a permutation.
  void scatter(Bytes& numbers, std::vector<std::string>& strings,
               Span<const std::uint32_t> places) const;
  /// Leaves the tuples of those ascending indices.
  void keep(Bytes& numbers, std::vector<std::string>& strings,
            const std::vector<std::size_t>& kept) const;

 private:
  bool strings_;
  std::size_t tuple_;  ///< bytes, or strings
};

}  // namespace bspc
