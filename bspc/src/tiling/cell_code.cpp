#include "tiling/cell_code.h"

#include <algorithm>

#include "entropy/symbol_coder.h"

namespace bspc::tiling {

CellCode::CellCode(const DyadicBox& box, unsigned depth)
    : box_(box), depth_(std::min(depth, box.depth())) {
  std::array<unsigned, 3> left = box.bits;
  std::array<unsigned, 3> used{};
  for (unsigned d = 0; d < depth_; ++d) {
    const auto longest =
        static_cast<unsigned>(std::max_element(left.begin(), left.end()) - left.begin());
    --left[longest];
    ++used[longest];
    axes_.push_back(longest);
  }
  for (unsigned k = 0; k < 3; ++k) {
    // Below 32: a side of 32 bits is among the longest, so it has been halved.
    shift_[k] = left[k];
    spread_[k].resize(std::size_t{1} << used[k]);
    for (std::uint32_t value = 0; value < spread_[k].size(); ++value) {
      unsigned bit = used[k];
      for (unsigned d = 0; d < depth_; ++d) {
        if (axes_[d] != k) continue;
        --bit;
        spread_[k][value] |= ((value >> bit) & 1U) << (depth_ - 1 - d);
      }
    }
  }
}

DyadicBox CellCode::cell(std::uint32_t code) const {
  DyadicBox cell = box_;
  for (unsigned d = 0; d < depth_; ++d) {
    const unsigned k = axes_[d];
    --cell.bits[k];
    if (((code >> (depth_ - 1 - d)) & 1U) != 0) cell.lower[k] += std::uint32_t{1} << cell.bits[k];
  }
  return cell;
}

DyadicBox dyadicBox(const GridPoint& lower, const GridPoint& upper) {
  DyadicBox box;
  box.lower = lower;
  for (unsigned k = 0; k < 3; ++k) box.bits[k] = entropy::bitLength(upper[k] - lower[k]);
  return box;
}

}  // namespace bspc::tiling
