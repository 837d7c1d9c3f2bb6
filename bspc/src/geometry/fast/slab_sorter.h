#pragma once

#include <cstdint>
#include <vector>

#include "geometry/fast/cell.h"
#include "geometry/fast/hilbert.h"
#include "geometry/fast/slab_planner.h"
#include "geometry/fast/uv_tree.h"

namespace bspc::geometry::fast {

/// Sorts numbers by some of their bits; a radix sort with room to keep.
class BitSorter {
 public:
  void sort(std::vector<std::uint64_t>& keys, unsigned fromBit, unsigned toBit);

 private:
  std::vector<std::uint64_t> spare_;
};

/// Order of codes along a curve.
class CodeSorter {
 public:
  /// order()[j] is the index of the j-th smallest code, of codes below 2^bits.
  const std::vector<std::uint32_t>& sort(const std::vector<std::uint64_t>& codes, unsigned bits);

 private:
  BitSorter sorter_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> order_;
};

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

}  // namespace bspc::geometry::fast
