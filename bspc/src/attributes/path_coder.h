#pragma once

#include <cstdint>
#include <vector>

#include "attributes/neighbours.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// How the path of the input through the points is followed.
struct PathSettings {
  unsigned momentum =
      0;  ///< halves of the last step by which the next point is expected ahead: 0 … 2
  unsigned coarser = 1;  ///< bits by which cells are larger where small ones hold too few: 1 … 4
};

/// Codes a path: path[t] is the rank of the t-th point. The first `limit` steps are coded.
Bytes writePath(const RankedPoints& points, const PathSettings& settings,
                std::vector<std::uint32_t>& path, std::size_t limit);

/// The path that was coded; every rank is in it once.
std::vector<std::uint32_t> readPath(ByteView stream, const RankedPoints& points,
                                    const PathSettings& settings);

}  // namespace bspc::attributes
