#pragma once

#include <array>
#include <cstdint>

#include "entropy/lanes.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// A box in a cell: lower corner in the tile, and log2 of the sides.
struct Box {
  std::array<std::uint32_t, 3> lower{};
  std::array<std::uint8_t, 3> open{};

  bool isPoint() const { return (open[0] | open[1] | open[2]) == 0; }
  /// From `axis` on, the next one that can be halved.
  unsigned openAxis(unsigned axis) const {
    while (open[axis] == 0) axis = after(axis);
    return axis;
  }
  static unsigned after(unsigned axis) { return axis == 2 ? 0 : axis + 1; }

  /// First coordinate of the upper half.
  std::uint64_t middle(unsigned axis) const {
    return std::uint64_t{lower[axis]} + (std::uint64_t{1} << (open[axis] - 1));
  }
  /// Makes it one of its halves.
  void descend(unsigned axis, bool upper) {
    --open[axis];
    if (upper) lower[axis] += std::uint32_t{1} << open[axis];
  }
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
