#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "geometry/fast/cell.h"
#include "geometry/output_budget.h"

namespace bspc::geometry::fast {

/// The distinct values 0 … extent of an axis, sorted; empty if replacing coordinates by ranks does
/// not pay. `coordinates` are relative to the tile's corner.
std::vector<std::uint32_t> valuesWorthRanking(const std::vector<std::uint32_t>& coordinates,
                                              std::uint32_t extent);

/// Rank of every coordinate.
std::vector<std::uint32_t> ranksOf(const std::vector<std::uint32_t>& coordinates,
                                   const std::vector<std::uint32_t>& values);

/// Steps between values: whether they are regular enough to speak of a typical one.
bool isRegular(const std::vector<std::uint32_t>& values);

/// Sorted values from 0 to the extent, of each axis that has ranks; the others are empty.
using AxisValues = std::array<std::vector<std::uint32_t>, 3>;

Bytes writeValues(const AxisValues& values);
/// Reads the values of the axes that `ranked` says. Throws Error(Corrupt).
AxisValues readValues(ByteView section, const std::array<bool, 3>& ranked, std::uint64_t maxValues,
                      const GridPoint& extent, const OutputBudget& budget);

}  // namespace bspc::geometry::fast
