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
  sortKeys(indexBits, indexBits + bits);
  const std::uint64_t mask = (std::uint64_t{1} << indexBits) - 1;
  for (std::size_t j = 0; j < n; ++j) order_[j] = static_cast<std::uint32_t>(keys_[j] & mask);
  return order_;
}

void CodeSorter::sortKeys(unsigned fromBit, unsigned toBit) {
  constexpr unsigned kMaxDigit = 10;
  const std::size_t n = keys_.size();
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
    for (const std::uint64_t key : keys_) ++starts[(key >> shift) & mask];
    std::uint32_t start = 0;
    for (std::size_t d = 0; d <= mask; ++d) {
      const std::uint32_t count = starts[d];
      starts[d] = start;
      start += count;
    }
    for (const std::uint64_t key : keys_) spare_[starts[(key >> shift) & mask]++] = key;
    keys_.swap(spare_);
  }
}

void SlabSorter::sort(const Cell& cell, const StepScale& scale, const TilePoint* points,
                      std::uint32_t count, unsigned heightAxis, SortedSlab& slab) {
  const HilbertPlane& curve = HilbertPlane::instance();
  const SlabFrame frame(cell, scale, heightAxis, count);
  slab.frame = frame;
  const unsigned au = frame.axis[0];
  const unsigned av = frame.axis[1];
  const unsigned aw = frame.axis[2];
  codes_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    codes_[i] = codeOf(curve, frame, (points[i].at[au] - cell.lower[au]) >> frame.cut[0],
                       (points[i].at[av] - cell.lower[av]) >> frame.cut[1]);
  }
  const std::vector<std::uint32_t>& order = sorter_.sort(codes_, frame.codeBits());
  for (auto* column : {&slab.u, &slab.v, &slab.w, &slab.index}) column->resize(count);
  slab.codes.resize(count);
  const unsigned cutBits = frame.cutBits();
  slab.cutOff.resize(cutBits > 0 ? count : 0);
  for (std::uint32_t j = 0; j < count; ++j) {
    const TilePoint& p = points[order[j]];
    const std::uint32_t u = p.at[au] - cell.lower[au];
    const std::uint32_t v = p.at[av] - cell.lower[av];
    const std::uint32_t w = p.at[aw] - cell.lower[aw];
    slab.codes[j] = codes_[order[j]];
    slab.u[j] = u >> frame.cut[0];
    slab.v[j] = v >> frame.cut[1];
    slab.w[j] = w >> frame.cut[2];
    slab.index[j] = p.index;
    if (cutBits > 0) {
      const auto low = [](std::uint32_t c, unsigned bits) { return c & ((1U << bits) - 1); };
      slab.cutOff[j] = low(u, frame.cut[0]) | (low(v, frame.cut[1]) << frame.cut[0]) |
                       (low(w, frame.cut[2]) << (frame.cut[0] + frame.cut[1]));
    }
  }
}

}  // namespace bspc::geometry::fast
