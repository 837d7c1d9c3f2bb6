#pragma once

#include <array>
#include <cstdint>

#include "entropy/lanes.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// What a decision is about: how the points of a box are shared out between its halves. Places are
/// in grid steps from the lower corner of the cell at hand; the middle of a grid position is half a
/// step above its index.
struct Question {
  std::array<float, 3> lower{};
  std::array<float, 3> size{};
  unsigned axis = 0;
  float middle = 0;         ///< where the axis is cut
  unsigned open = 1;        ///< log2 of size[axis], at least 1
  std::uint32_t value = 0;  ///< index of the box's first grid position along the axis, in the tile

  float centre(unsigned k) const { return lower[k] + 0.5F * size[k]; }

  /// The same box is to be cut across `axis`, where it is 2^`log2Size` large and begins at `first`.
  void turnTo(unsigned newAxis, unsigned log2Size, std::uint32_t first) {
    axis = newAxis;
    middle = centre(newAxis);
    open = log2Size;
    value = first;
  }
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
