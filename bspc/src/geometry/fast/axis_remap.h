#pragma once

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

Bytes writeValues(const std::vector<std::uint32_t>& values);
/// Reads at most `maxValues` values that end with `extent`. Throws Error(Corrupt).
std::vector<std::uint32_t> readValues(ByteView section, std::uint64_t maxValues,
                                      std::uint32_t extent, const OutputBudget& budget);

}  // namespace bspc::geometry::fast
