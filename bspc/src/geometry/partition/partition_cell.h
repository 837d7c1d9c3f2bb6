#pragma once

#include <cstdint>

#include "bspc/grid.h"

namespace bspc::geometry {

/// What a partition tells of the points of a cell without counting them.
enum class Occupancy : std::uint8_t {
  None,
  One,
  Many,  ///< two or more
  Some,  ///< one or more
};

/// A cell of an axis-aligned partition: a box whose sides are powers of two.
struct PartitionCell {
  GridPoint lower{};
  Occupancy occupancy = Occupancy::Some;
  std::uint8_t history = 0;  ///< of the ancestors' splits, for contexts
  bool known = false;        ///< the decoder knows `count` too
  std::uint64_t count = 0;
  std::uint64_t first = 0;  ///< number of points in the leaves before it; the encoder's
  std::uint64_t id = 0;     ///< of its ancestor in the layer that cell ids are asked of

  bool lone() const { return occupancy == Occupancy::One || (known && count == 1); }
  /// Fewest points that it can hold.
  std::uint64_t least() const { return occupancy == Occupancy::Many ? 2 : 1; }
};

}  // namespace bspc::geometry
