#pragma once

// For one instruction set.

#include <cstdint>
#include <vector>

#include "entropy/lane_set.h"
#include "geometry/fast/set_points.h"
#include "geometry/fast/slab_curve.h"
#include "geometry/fast/slab_sorter.h"

namespace bspc::geometry::fast {
inline namespace BSPC_LANE_SET {

/// The points of a slab along its curve.
class SortedSlab {
 public:
  void sort(const Cell& cell, const StepScale& scale, const TilePoint* points, std::uint32_t count,
            unsigned heightAxis);

  const SlabFrame& frame() const { return frame_; }
  std::size_t size() const { return keys_.size(); }
  /// The j-th point along the curve.
  const TilePoint& point(std::size_t j) const { return points_[keys_[j] & indexMask_]; }
  std::uint64_t code(std::size_t j) const { return keys_[j] >> indexBits_; }
  /// Coordinate k of the frame, u, v or w, without the bits that are cut off.
  std::uint32_t coordinate(const TilePoint& p, unsigned k) const {
    return (p.at[frame_.axis[k]] - lower_[k]) >> frame_.cut[k];
  }
  /// The bits that are cut off, those of u lowest.
  std::uint32_t cutOff(const TilePoint& p) const;

 private:
  SlabFrame frame_;
  std::uint32_t lower_[3] = {};  ///< corner of the cell
  const TilePoint* points_ = nullptr;
  BitSorter sorter_;
  std::vector<std::uint64_t> keys_;  ///< code, then index among points_
  unsigned indexBits_ = 0;
  std::uint64_t indexMask_ = 0;
};

inline void SortedSlab::sort(const Cell& cell, const StepScale& scale, const TilePoint* points,
                             std::uint32_t count, unsigned heightAxis) {
  const HilbertPlane& curve = HilbertPlane::instance();
  frame_ = SlabFrame(cell, scale, heightAxis, count);
  for (unsigned k = 0; k < 3; ++k) lower_[k] = cell.lower[frame_.axis[k]];
  points_ = points;
  // Larger slabs than an encoder makes have a single position, and so no bits of code: both fit.
  indexBits_ = count > 0 ? entropy::bitLength(count - 1) : 0;
  indexMask_ = (std::uint64_t{1} << indexBits_) - 1;
  keys_.resize(count);
  const SlabFrame frame = frame_;  // copies live in registers
  const unsigned indexBits = indexBits_;
  const std::uint32_t lowerU = lower_[0];
  const std::uint32_t lowerV = lower_[1];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t code =
        codeOf(curve, frame, (points[i].at[frame.axis[0]] - lowerU) >> frame.cut[0],
               (points[i].at[frame.axis[1]] - lowerV) >> frame.cut[1]);
    keys_[i] = (code << indexBits) | i;
  }
  sorter_.sort(keys_, indexBits_, indexBits_ + frame.codeBits());
}

inline std::uint32_t SortedSlab::cutOff(const TilePoint& p) const {
  std::uint32_t bits = 0;
  unsigned before = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const std::uint32_t all = p.at[frame_.axis[k]] - lower_[k];
    bits |= (all & ((1U << frame_.cut[k]) - 1)) << before;
    before += frame_.cut[k];
  }
  return bits;
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::fast
