#include "tiling/tile_cut.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "tiling/cell_code.h"

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
  /// Cells next to each other in the order of their codes that go into one tile.
  struct Group {
    std::size_t points = 0;
    bool small = false;  ///< whether others may still join
  };

  void cutRange(std::size_t first, std::size_t last) {
    if (last - first <= most_) {
      if (first < last) cut_.firsts.push_back(first);
      return;
    }
    const DyadicBox box = boxOf(first, last);
    if (box.depth() == 0) return cutEqual(first, last);
    const CellCode code(box, kLevelsAtOnce);
    std::vector<std::size_t> counts(code.cells());
    for (std::size_t i = first; i < last; ++i) ++counts[code(points_[cut_.order[i]])];
    const std::vector<std::size_t> sizes = groupCells(counts);
    sortIntoGroups(first, last, code, sizes.size());
    for (const std::size_t size : sizes) {
      cutRange(first, first + size);
      first += size;
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

  /// Fills groupOf_ and returns the sizes of the groups, none of them empty.
  std::vector<std::size_t> groupCells(const std::vector<std::size_t>& counts) {
    groupOf_.assign(counts.size(), 0);
    groups_.clear();
    groupSubtree(counts, 0, counts.size());
    std::vector<std::size_t> sizes;
    sizes.reserve(groups_.size());
    for (const Group& group : groups_) sizes.push_back(group.points);
    return sizes;
  }

  void groupSubtree(const std::vector<std::size_t>& counts, std::size_t first, std::size_t last) {
    const std::size_t points =
        std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(first),
                        counts.begin() + static_cast<std::ptrdiff_t>(last), std::size_t{0});
    if (points == 0) return;
    if (points > most_ && last - first > 1) {
      const std::size_t middle = first + (last - first) / 2;
      groupSubtree(counts, first, middle);
      groupSubtree(counts, middle, last);
      return;
    }
    // A tile of few points costs more than a box that is a little larger.
    const bool small = points < most_ / 4;
    const bool joins = !groups_.empty() && (small || groups_.back().small) &&
                       groups_.back().points + points <= most_;
    if (!joins) groups_.push_back({0, small});
    groups_.back().points += points;
    groups_.back().small = groups_.back().points < most_ / 4;
    std::fill(groupOf_.begin() + static_cast<std::ptrdiff_t>(first),
              groupOf_.begin() + static_cast<std::ptrdiff_t>(last),
              static_cast<std::uint32_t>(groups_.size() - 1));
  }

  /// Stable: points of a tile stay in the order of the input.
  void sortIntoGroups(std::size_t first, std::size_t last, const CellCode& code,
                      std::size_t groups) {
    std::vector<std::size_t> next(groups, 0);
    for (std::size_t g = 1; g < groups; ++g) next[g] = next[g - 1] + groups_[g - 1].points;
    std::vector<std::uint32_t> sorted(last - first);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t index = cut_.order[i];
      sorted[next[groupOf_[code(points_[index])]]++] = index;
    }
    std::copy(sorted.begin(), sorted.end(),
              cut_.order.begin() + static_cast<std::ptrdiff_t>(first));
  }

  Span<const GridPoint> points_;
  std::size_t most_;
  TileCut cut_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> groupOf_;  ///< by code of the cell
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
