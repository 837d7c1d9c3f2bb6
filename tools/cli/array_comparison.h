#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::cli {

/// Points on a grid and their arrays, all of which somebody else owns.
struct PointTable {
  Span<const GridPoint> points;
  std::vector<ArrayView> arrays;
};

/// How far arrays of the same points are apart.
struct ArrayComparison {
  /// For each array the greatest error of a value, or angle of a normal in degrees; 0 if all values
  /// are the same bit for bit.
  std::vector<double> greatestErrors;
  /// A point of the given table, and an array, for which the other has no match.
  struct Mismatch {
    std::uint64_t point = 0;
    std::size_t array = 0;
  };
  std::optional<Mismatch> mismatch;
};

/// Compares tables with the same arrays, in that order, and equally many points. `partners` names
/// for each restored point the given one that it is; without it, the tables hold the same points in
/// any order, and those at the same place are matched by their values. Tolerances of the arrays are
/// the same in both.
ArrayComparison compareArrays(const PointTable& given, const PointTable& restored,
                              const std::optional<std::vector<std::uint64_t>>& partners);

}  // namespace bspc::cli
