#pragma once

#include <cstdint>
#include <vector>

#include "geometry/fast/cell.h"
#include "geometry/fast/hilbert.h"
#include "geometry/fast/slab_planner.h"
#include "geometry/fast/uv_tree.h"

namespace bspc::geometry::fast {

/// Order of codes along a slab's curve; a radix sort with room to keep.
class CodeSorter {
 public:
  /// order()[j] is the index of the j-th smallest code, of codes below 2^bits.
  const std::vector<std::uint32_t>& sort(const std::vector<std::uint64_t>& codes, unsigned bits);

 private:
  void sortKeys(unsigned fromBit, unsigned toBit);

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> spare_;
  std::vector<std::uint32_t> order_;
};

/// A slab's points in local coordinates, along its curve.
struct SortedSlab {
  SlabFrame frame;
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> u;
  std::vector<std::uint32_t> v;
  std::vector<std::uint32_t> w;
  std::vector<std::uint32_t> cutOff;
  std::vector<std::uint32_t> index;

  std::size_t size() const { return codes.size(); }
};

class SlabSorter {
 public:
  void sort(const Cell& cell, const StepScale& scale, const TilePoint* points, std::uint32_t count,
            unsigned heightAxis, SortedSlab& slab);

 private:
  CodeSorter sorter_;
  std::vector<std::uint64_t> codes_;
};

}  // namespace bspc::geometry::fast
