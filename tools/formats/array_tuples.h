#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/span.h"
#include "formats/array_columns.h"

namespace bspc::formats {

/// Appends `count` tuples of zeros to an array of numbers and returns where they begin.
std::uint8_t* appendTuples(ArrayValues& array, std::size_t count);

/// Appends one tuple to each array.
void appendTuple(Span<ArrayValues> arrays);

/// Where the number of a column goes: into the last tuple of an array.
struct ColumnTarget {
  static constexpr std::size_t kNone = SIZE_MAX;

  std::size_t array = kNone;
  /// Bytes from the number to the end of the tuple.
  std::size_t bytesToEnd = 0;

  std::uint8_t* at(Span<ArrayValues> arrays) const {
    Bytes& values = arrays[array].values;
    return values.data() + (values.size() - bytesToEnd);
  }
};

/// The target of each of a file's columns; none for those that no group has.
std::vector<ColumnTarget> targetsOf(const std::vector<GroupedColumns>& groups, std::size_t columns);

/// The descriptions of the groups' arrays.
std::vector<ArrayDescription> arraysOf(const std::vector<GroupedColumns>& groups);

/// Arrays without values, one for each description.
std::vector<ArrayValues> emptyArrays(const std::vector<ArrayDescription>& descriptions);

}  // namespace bspc::formats
