#include "geometry/fast/slab_sorter.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "entropy/symbol_coder.h"

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

}  // namespace bspc::geometry::fast
