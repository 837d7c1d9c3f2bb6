#include "geometry/kd/kd_order.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace bspc::geometry {

namespace {

struct Path {
  std::uint64_t high = 0;
  std::uint32_t low = 0;
};

/// Spreads coordinates over the depths of the schedule, a byte at a time.
class PathTable {
 public:
  explicit PathTable(const KdSchedule& schedule) {
    std::array<std::array<Path, 32>, 3> ofBit{};
    for (unsigned d = 0; d < schedule.depth(); ++d) {
      const unsigned axis = schedule.axis(d);
      Path& path = ofBit[axis][schedule.openBits(d + 1, axis)];
      if (d < 64) {
        path.high = std::uint64_t{1} << (63 - d);
      } else {
        path.low = std::uint32_t{1} << (95 - d);
      }
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned part = 0; part < 4; ++part) {
        auto& table = tables_[axis][part];
        for (unsigned value = 1; value < 256; ++value) {
          const auto lowest = static_cast<unsigned>(__builtin_ctz(value));
          const Path rest = table[value & (value - 1)];
          const Path bit = ofBit[axis][8 * part + lowest];
          table[value] = {rest.high | bit.high, rest.low | bit.low};
        }
      }
    }
  }

  Path path(const GridPoint& point, const GridPoint& lower) const {
    Path sum;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::uint32_t v = point[axis] - lower[axis];
      for (unsigned part = 0; part < 4; ++part) {
        const Path& p = tables_[axis][part][(v >> (8 * part)) & 255];
        sum.high |= p.high;
        sum.low |= p.low;
      }
    }
    return sum;
  }

 private:
  std::array<std::array<std::array<Path, 256>, 4>, 3> tables_{};
};

}  // namespace

KdOrder::KdOrder(const TileInput& tile, const KdSchedule& schedule) {
  const std::size_t n = tile.points.size();
  const PathTable table(schedule);
  high_.resize(n);
  if (schedule.depth() > 64) low_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Path path = table.path(tile.points[i], tile.lower);
    high_[i] = path.high;
    if (!low_.empty()) low_[i] = path.low;
  }
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0U);
  sortByHigh(schedule.depth());
  if (!low_.empty()) sortRunsByLow();
}

// Least significant digit first; stable, so equal points keep the input's order.
void KdOrder::sortByHigh(unsigned depth) {
  constexpr unsigned kDigit = 11;
  const std::size_t n = high_.size();
  std::vector<std::uint64_t> keys(n);
  std::vector<std::uint32_t> indices(n);
  const unsigned used = std::min(depth, 64U);
  for (unsigned done = 0; done < used; done += kDigit) {
    const unsigned shift = 64 - used + done;
    std::array<std::size_t, (1U << kDigit)> start{};
    const auto digit = [shift](std::uint64_t key) { return (key >> shift) & ((1U << kDigit) - 1); };
    for (const std::uint64_t key : high_) ++start[digit(key)];
    std::size_t sum = 0;
    for (std::size_t& s : start) {
      const std::size_t here = s;
      s = sum;
      sum += here;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t to = start[digit(high_[i])]++;
      keys[to] = high_[i];
      indices[to] = order_[i];
    }
    high_.swap(keys);
    order_.swap(indices);
  }
}

void KdOrder::sortRunsByLow() {
  const std::size_t n = high_.size();
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    while (end < n && high_[end] == high_[begin]) ++end;
    const auto at = [this](std::size_t i) {
      return order_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::stable_sort(at(begin), at(end),
                     [this](std::uint32_t a, std::uint32_t b) { return low_[a] < low_[b]; });
    begin = end;
  }
  // Until here low_ is in input order; now it follows the sorted one.
  std::vector<std::uint32_t> sorted(n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = low_[order_[i]];
  low_.swap(sorted);
}

std::uint64_t KdOrder::countLower(std::uint64_t first, std::uint64_t count, unsigned depth) const {
  constexpr std::uint64_t kScan = 12;
  if (count <= kScan) {
    std::uint64_t lower = 0;
    while (lower < count && !upper(first + lower, depth)) ++lower;
    return lower;
  }
  std::uint64_t low = 0;
  std::uint64_t high = count;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (upper(first + middle, depth)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace bspc::geometry
