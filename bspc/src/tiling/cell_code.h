#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"

namespace bspc::tiling {

/// A box of the grid whose sides are powers of two.
struct DyadicBox {
  GridPoint lower{};
  std::array<unsigned, 3> bits{};  ///< side k has 2^bits[k] steps

  unsigned depth() const { return bits[0] + bits[1] + bits[2]; }
};

/// Numbers the cells that a box falls into when it is halved `depth` times, each time across the
/// longest side (of equal ones the first): the code's bits are the halves taken, the first on top.
class CellCode {
 public:
  CellCode(const DyadicBox& box, unsigned depth);

  std::uint32_t operator()(const GridPoint& p) const {
    std::uint32_t code = 0;
    for (unsigned k = 0; k < 3; ++k) code |= spread_[k][(p[k] - box_.lower[k]) >> shift_[k]];
    return code;
  }
  unsigned depth() const { return depth_; }
  std::size_t cells() const { return std::size_t{1} << depth_; }
  /// The box of one cell.
  DyadicBox cell(std::uint32_t code) const;

 private:
  DyadicBox box_;
  unsigned depth_;
  std::vector<unsigned> axes_;  ///< which side each halving cuts
  std::array<unsigned, 3> shift_{};
  /// Per axis: the bits of the code for each value of the coordinate's upper bits.
  std::array<std::vector<std::uint32_t>, 3> spread_;
};

/// The smallest dyadic box from the lower corner that holds all points.
DyadicBox dyadicBox(const GridPoint& lower, const GridPoint& upper);

}  // namespace bspc::tiling
