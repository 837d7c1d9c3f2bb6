#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/memory_budget.h"
#include "bspc/span.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::attributes {

/// Things that a lossy method cannot restore well enough, with their own bytes.
struct ExceptionList {
  std::vector<std::uint64_t> places;  ///< ascending
  Bytes contents;                     ///< of equal size each

  void add(std::uint64_t place, ByteView content) {
    places.push_back(place);
    contents.insert(contents.end(), content.begin(), content.end());
  }

  /// Missing values are often alike and beside each other: both parts are packed.
  void write(container::ByteWriter& out) const;

  /// Places are below `end`; each thing has `size` bytes.
  static ExceptionList read(container::ByteReader& in, std::uint64_t end, std::size_t size,
                            MemoryBudget& budget);
};

}  // namespace bspc::attributes
