#include "geometry/fast/slab_sorter.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "geometry/fast/slab_curve.h"

namespace bspc::geometry::fast {

const std::vector<std::uint32_t>& CodeSorter::sort(const std::vector<std::uint64_t>& codes,
                                                   unsigned bits) {
  const std::size_t n = codes.size();
  order_.resize(n);
  const unsigned indexBits = n > 0 ? entropy::bitLength(n - 1) : 0;
  if (bits + indexBits > 64) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&codes](std::uint32_t a, std::uint32_t b) {
      return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
    });
    return order_;
  }
  keys_.resize(n);
  for (std::size_t i = 0; i < n; ++i) keys_[i] = (codes[i] << indexBits) | i;
  sorter_.sort(keys_, indexBits, indexBits + bits);
  const std::uint64_t mask = (std::uint64_t{1} << indexBits) - 1;
  for (std::size_t j = 0; j < n; ++j) order_[j] = static_cast<std::uint32_t>(keys_[j] & mask);
  return order_;
}

void BitSorter::sort(std::vector<std::uint64_t>& keys, unsigned fromBit, unsigned toBit) {
  constexpr unsigned kMaxDigit = 10;
  const std::size_t n = keys.size();
  const unsigned most = n < 400 ? 7 : n < 1500 ? 9 : kMaxDigit;
  const unsigned bits = toBit - fromBit;
  if (bits == 0) return;
  const unsigned passes = (bits + most - 1) / most;
  const unsigned digit = (bits + passes - 1) / passes;
  spare_.resize(n);
  std::array<std::uint32_t, 1U << kMaxDigit> starts;
  for (unsigned shift = fromBit; shift < toBit; shift += digit) {
    const std::uint64_t mask = (std::uint64_t{1} << std::min(digit, toBit - shift)) - 1;
    std::fill(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(mask) + 1, 0U);
    for (const std::uint64_t key : keys) ++starts[(key >> shift) & mask];
    std::uint32_t start = 0;
    for (std::size_t d = 0; d <= mask; ++d) {
      const std::uint32_t count = starts[d];
      starts[d] = start;
      start += count;
    }
    for (const std::uint64_t key : keys) spare_[starts[(key >> shift) & mask]++] = key;
    keys.swap(spare_);
  }
}

void SortedSlab::sort(const Cell& cell, const StepScale& scale, const TilePoint* points,
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

std::uint32_t SortedSlab::cutOff(const TilePoint& p) const {
  std::uint32_t bits = 0;
  unsigned before = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const std::uint32_t all = p.at[frame_.axis[k]] - lower_[k];
    bits |= (all & ((1U << frame_.cut[k]) - 1)) << before;
    before += frame_.cut[k];
  }
  return bits;
}

}  // namespace bspc::geometry::fast
