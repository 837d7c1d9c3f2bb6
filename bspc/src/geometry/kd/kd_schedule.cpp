#include "geometry/kd/kd_schedule.h"

#include <algorithm>

#include "entropy/symbol_coder.h"

namespace bspc::geometry {

KdSchedule::KdSchedule(const GridPoint& extent) : extent_(extent) {
  for (unsigned k = 0; k < 3; ++k) {
    open_[0][k] = static_cast<std::uint8_t>(entropy::bitLength(extent[k]));
  }
  for (;;) {
    const std::array<std::uint8_t, 3>& open = open_[depth_];
    const auto longest =
        static_cast<unsigned>(std::max_element(open.begin(), open.end()) - open.begin());
    if (open[longest] == 0) return;
    axis_[depth_] = static_cast<std::uint8_t>(longest);
    open_[depth_ + 1] = open;
    --open_[depth_ + 1][longest];
    ++depth_;
  }
}

std::uint32_t KdSchedule::spread(unsigned depth) const {
  const unsigned widest = *std::max_element(open_[depth].begin(), open_[depth].end());
  return static_cast<std::uint32_t>((std::uint64_t{1} << widest) / 2);
}

}  // namespace bspc::geometry
