#pragma once

#include <cstdint>
#include <vector>

#include "geometry/geometry_method.h"
#include "geometry/kd/kd_schedule.h"

namespace bspc::geometry {

/// The points of a tile in the order of the kd-tree's leaves, each as the path that leads to it:
/// one bit a depth, 1 for the upper half.
class KdOrder {
 public:
  KdOrder(const TileInput& tile, const KdSchedule& schedule);

  /// order()[j]: input index of the j-th leaf point.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::vector<std::uint32_t> takeOrder() { return std::move(order_); }

  /// How many of the points first … first + count − 1, which share a cell at `depth`, lie in its
  /// lower half.
  std::uint64_t countLower(std::uint64_t first, std::uint64_t count, unsigned depth) const;

 private:
  bool upper(std::uint64_t j, unsigned depth) const {
    return depth < 64 ? ((high_[j] >> (63 - depth)) & 1) != 0
                      : ((low_[j] >> (95 - depth)) & 1) != 0;
  }
  void sortByHigh(unsigned depth);
  void sortRunsByLow();

  std::vector<std::uint64_t> high_;  ///< depths 0 … 63, from the most significant bit on
  std::vector<std::uint32_t> low_;   ///< depths 64 … 95; empty if the tree is no deeper than 64
  std::vector<std::uint32_t> order_;
};

}  // namespace bspc::geometry
