#pragma once

#include <array>
#include <cstdint>

#include "bspc/decoder.h"
#include "bspc/grid.h"

namespace bspc {

/// A box in the units of the data, as ranges of indices of a grid. On a grid of float bits with low
/// halves the outermost indices lie in it in part.
class BoxFilter {
 public:
  /// Throws Error(InvalidArgument) if the box has no inside or is not of numbers.
  BoxFilter(const Grid& grid, const Box& box);

  /// Whether any point of the box lower … upper can be inside.
  bool touches(const GridPoint& lower, const GridPoint& upper) const;
  bool contains(const GridPoint& p, const GridPoint& lowHalves = {}) const {
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && first_[k] <= p[k] && p[k] <= last_[k];
    return inside && !empty_ && (!halved_ || holds(p, lowHalves));
  }
  /// Takes out what is not inside.
  void apply(DecodedPoints& points) const;

 private:
  void setFloatRange(const Grid& grid, std::size_t axis);
  bool holds(const GridPoint& p, const GridPoint& lowHalves) const;

  Box box_;
  bool halved_ = false;  ///< the grid has low halves, with these bases:
  GridPoint bases_{};
  GridPoint first_{};
  GridPoint last_{};
  bool empty_ = false;  ///< the box lies between two steps, or beside the grid
};

}  // namespace bspc
