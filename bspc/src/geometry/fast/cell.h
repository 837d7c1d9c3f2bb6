#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "bspc/grid.h"
#include "entropy/symbol_coder.h"

namespace bspc::geometry::fast {

/// log2 of how much coarser than the finest axis an axis's steps are, after its values were
/// replaced by their ranks; so that cells are halved where they are really longest.
using StepScale = std::array<std::uint8_t, 3>;

/// A cell of the dyadic partition: sides of 2^levels steps.
struct Cell {
  GridPoint lower{};
  std::array<std::uint8_t, 3> levels{};

  bool isUnit() const { return (levels[0] | levels[1] | levels[2]) == 0; }

  /// The longest axis, the first of equal ones; the cell must not be of one step.
  unsigned splitAxis(const StepScale& scale) const {
    int longest = -1;
    unsigned axis = 0;
    for (unsigned k = 0; k < 3; ++k) {
      if (levels[k] > 0 && levels[k] + scale[k] > longest) {
        longest = levels[k] + scale[k];
        axis = k;
      }
    }
    return axis;
  }
  Cell lowerHalf(unsigned axis) const {
    Cell half = *this;
    --half.levels[axis];
    return half;
  }
  Cell upperHalf(unsigned axis) const {
    Cell half = lowerHalf(axis);
    half.lower[axis] += std::uint32_t{1} << half.levels[axis];
    return half;
  }
};

inline Cell rootCell(const GridPoint& extent) {
  Cell root;
  for (unsigned k = 0; k < 3; ++k) {
    root.levels[k] = static_cast<std::uint8_t>(entropy::bitLength(extent[k]));
  }
  return root;
}

/// Local coordinates of a slab: u and v span it, w is its height. Coordinates keep their leading
/// kMaxLevels bits; what is cut off below is noise at that scale and coded raw.
struct SlabFrame {
  static constexpr unsigned kMaxLevels = 22;
  static constexpr std::uint32_t kLargeSlab = 4096;

  unsigned axis[3] = {};     ///< of u, v, w
  unsigned cut[3] = {};      ///< bits cut off from u, v, w
  unsigned levels[3] = {};   ///< bits left
  unsigned curveLevels = 0;  ///< of the Hilbert curve over the leading bits of u and v
  unsigned below[2] = {};    ///< bits of u and v below the curve's finest cells

  SlabFrame() = default;
  SlabFrame(const Cell& cell, const StepScale& scale, unsigned heightAxis, std::uint64_t points) {
    int top = 0;
    for (unsigned k = 0; k < 3; ++k) {
      axis[k] = (heightAxis + 1 + k) % 3;
      const unsigned all = cell.levels[axis[k]];
      levels[k] = std::min(all, kMaxLevels);
      cut[k] = all - levels[k];
      if (k < 2) top = std::max<int>(top, static_cast<int>(levels[k]) + scale[axis[k]]);
    }
    const int finest = std::max(0, top - (points > kLargeSlab ? 12 : 8));
    unsigned most = 0;
    for (unsigned k = 0; k < 2; ++k) {
      below[k] = std::min(static_cast<unsigned>(std::max(0, finest - scale[axis[k]])), levels[k]);
      most = std::max(most, levels[k] - below[k]);
    }
    curveLevels = most <= 4 ? 4 : most <= 8 ? 8 : 12;
  }

  /// Bits of codes that are ever set: see codeOf() in slab_curve.h.
  unsigned codeBits() const {
    const unsigned most = std::max(levels[0] - below[0], levels[1] - below[1]);
    return 2 * most + below[0] + below[1];
  }
  unsigned cutBits() const { return cut[0] + cut[1] + cut[2]; }
};

}  // namespace bspc::geometry::fast
