#pragma once

#include <array>
#include <cstdint>

#include "bspc/grid.h"

namespace bspc::geometry {

/// Which axis a kd-tree over a box splits at each depth. The root is the smallest box of powers of
/// two around the tile's; every cell is halved across its longest side (ties: x, y, z), so the
/// axis depends on the depth alone.
class KdSchedule {
 public:
  static constexpr unsigned kMaxDepth = 96;

  explicit KdSchedule(const GridPoint& extent);

  const GridPoint& extent() const { return extent_; }
  /// Depth at which cells are single grid positions.
  unsigned depth() const { return depth_; }
  unsigned axis(unsigned depth) const { return axis_[depth]; }
  /// Bits that are still open along `axis` in a cell at `depth`: its side is 2^that.
  unsigned openBits(unsigned depth, unsigned axis) const { return open_[depth][axis]; }
  /// Greatest distance along an axis of a point to the middle of its cell at `depth`.
  std::uint32_t spread(unsigned depth) const;

 private:
  GridPoint extent_;
  unsigned depth_ = 0;
  std::array<std::uint8_t, kMaxDepth> axis_{};
  std::array<std::array<std::uint8_t, 3>, kMaxDepth + 1> open_{};
};

}  // namespace bspc::geometry
