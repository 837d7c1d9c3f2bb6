#include "tiling/tile_cut.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "tiling/cell_code.h"
#include "tiling/cell_groups.h"

namespace bspc::tiling {

namespace {

/// Levels of the partition that are counted at a time; a table of them stays in the cache.
constexpr unsigned kLevelsAtOnce = 15;

class TileCutter {
 public:
  TileCutter(Span<const GridPoint> points, std::size_t most) : points_(points), most_(most) {}

  TileCut cut() {
    cut_.order.resize(points_.size());
    std::iota(cut_.order.begin(), cut_.order.end(), 0U);
    cutRange(0, points_.size());
    cut_.firsts.push_back(points_.size());
    return std::move(cut_);
  }

 private:
  void cutRange(std::size_t first, std::size_t last) {
    if (last - first <= most_) {
      if (first < last) cut_.firsts.push_back(first);
      return;
    }
    const DyadicBox box = boxOf(first, last);
    if (box.depth() == 0) return cutEqual(first, last);
    const CellCode code(box, kLevelsAtOnce);
    std::vector<std::uint64_t> counts(code.cells());
    for (std::size_t i = first; i < last; ++i) ++counts[code(points_[cut_.order[i]])];
    const CellGroups groups = groupCells(counts, most_);
    sortIntoGroups(first, last, code, groups);
    for (const std::uint64_t size : groups.sizes) {
      cutRange(first, first + static_cast<std::size_t>(size));
      first += static_cast<std::size_t>(size);
    }
  }

  /// Points at one place: any of them go together.
  void cutEqual(std::size_t first, std::size_t last) {
    for (; first < last; first += std::min(most_, last - first)) cut_.firsts.push_back(first);
  }

  DyadicBox boxOf(std::size_t first, std::size_t last) const {
    GridPoint lower = points_[cut_.order[first]];
    GridPoint upper = lower;
    for (std::size_t i = first; i < last; ++i) {
      const GridPoint& p = points_[cut_.order[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        lower[k] = std::min(lower[k], p[k]);
        upper[k] = std::max(upper[k], p[k]);
      }
    }
    return dyadicBox(lower, upper);
  }

  /// Stable: points of a tile stay in the order of the input.
  void sortIntoGroups(std::size_t first, std::size_t last, const CellCode& code,
                      const CellGroups& groups) {
    std::vector<std::uint64_t> next(groups.sizes.size(), 0);
    for (std::size_t g = 1; g < next.size(); ++g) next[g] = next[g - 1] + groups.sizes[g - 1];
    std::vector<std::uint32_t> sorted(last - first);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t index = cut_.order[i];
      sorted[static_cast<std::size_t>(next[groups.groupOf[code(points_[index])]]++)] = index;
    }
    std::copy(sorted.begin(), sorted.end(),
              cut_.order.begin() + static_cast<std::ptrdiff_t>(first));
  }

  Span<const GridPoint> points_;
  std::size_t most_;
  TileCut cut_;
};

}  // namespace

TileCut cutTiles(Span<const GridPoint> points, std::size_t most) {
  TileCut cut;
  if (points.size() <= most) {
    cut.firsts = {0};
    if (!points.empty()) cut.firsts.push_back(points.size());
    return cut;
  }
  return TileCutter(points, most).cut();
}

}  // namespace bspc::tiling
