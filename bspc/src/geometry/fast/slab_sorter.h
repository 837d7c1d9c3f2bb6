#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace bspc::geometry::fast
