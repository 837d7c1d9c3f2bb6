#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/span.h"

namespace bspc::streaming {

/// What belongs to a point beside its position, as bytes of one length: the tuples of its arrays,
/// then its index in the input if that is an array too.
class RecordLayout {
 public:
  /// Throws Error(Unsupported) for strings, which have no one length.
  RecordLayout(const std::vector<ArrayDescription>& arrays, bool originalIds);

  std::size_t bytes() const { return bytes_; }
  /// The records of the points `kept` of a piece, whose first has tuple `firstTuple` of the values
  /// and the index `firstIndex` in the input.
  Bytes pack(Span<const ArrayValues> values, std::size_t firstTuple,
             const std::vector<std::uint64_t>& kept, std::uint64_t firstIndex) const;
  /// The arrays in records that stand `strideBytes` apart; `records` is null if there are none.
  std::vector<ArrayView> views(const std::uint8_t* records, std::size_t strideBytes,
                               std::uint64_t count) const;

 private:
  std::vector<ArrayDescription> arrays_;  ///< that of the indices among them
  bool originalIds_;
  std::vector<std::size_t> sizes_;
  std::size_t bytes_ = 0;
};

}  // namespace bspc::streaming
