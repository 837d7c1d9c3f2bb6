#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/array_coder.h"
#include "bspc/arrays.h"
#include "bspc/span.h"

namespace bspc {

/// Name and semantic of the array that EncodeOptions::originalIds adds.
ArrayDescription originalIdsDescription();

/// The arrays of a point set that is being coded: those that the caller has, and their indices.
class ArraySource {
 public:
  ArraySource() = default;
  /// `arrays` must outlive this; the first `hidden` of them are no arrays to the users of a file.
  ArraySource(Span<const ArrayView> arrays, std::size_t hidden, bool originalIds)
      : arrays_(arrays), hidden_(hidden), originalIds_(originalIds) {}

  std::size_t hidden() const { return hidden_; }
  std::size_t size() const { return arrays_.size() + (originalIds_ ? 1 : 0); }
  ArrayDescription description(std::size_t array) const;
  attributes::ArrayShape shape(std::size_t array) const;
  /// The tuples of those points of the input, one after the other.
  attributes::ArrayValues gather(std::size_t array,
                                 const std::vector<std::uint64_t>& sources) const;

 private:
  Span<const ArrayView> arrays_;
  std::size_t hidden_ = 0;
  bool originalIds_ = false;
};

}  // namespace bspc
