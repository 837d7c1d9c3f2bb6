#pragma once

#include <cstdint>
#include <vector>

namespace bspc::tiling {

/// Cells of a partition, put together in the order of their codes.
struct CellGroups {
  std::vector<std::uint32_t> groupOf;  ///< by code of the cell; any for empty cells
  std::vector<std::uint64_t> sizes;    ///< points of each group, none of them 0
};

/// Puts cells together into subtrees of at most `most` points, as large as they can be, and small
/// ones with the one before. `counts`: points by code, a power of two of them. A single cell may
/// have more points than `most`.
CellGroups groupCells(const std::vector<std::uint64_t>& counts, std::uint64_t most);

}  // namespace bspc::tiling
