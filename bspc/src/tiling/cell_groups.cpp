#include "tiling/cell_groups.h"

#include <algorithm>
#include <cstddef>

namespace bspc::tiling {

namespace {

class Grouper {
 public:
  Grouper(const std::vector<std::uint64_t>& counts, std::uint64_t most) : most_(most) {
    groups_.groupOf.assign(counts.size(), 0);
    // sums_[i]: points of the cells before i, so that every subtree's are one difference.
    sums_.reserve(counts.size() + 1);
    sums_.push_back(0);
    for (const std::uint64_t count : counts) sums_.push_back(sums_.back() + count);
  }

  CellGroups run() {
    addSubtree(0, groups_.groupOf.size());
    return std::move(groups_);
  }

 private:
  /// A group of few points costs more than a box that is a little larger.
  bool isSmall(std::uint64_t points) const { return points < most_ / 4; }

  void addSubtree(std::size_t first, std::size_t last) {
    const std::uint64_t points = sums_[last] - sums_[first];
    if (points == 0) return;
    if (points > most_ && last - first > 1) {
      const std::size_t middle = first + (last - first) / 2;
      addSubtree(first, middle);
      addSubtree(middle, last);
      return;
    }
    std::vector<std::uint64_t>& sizes = groups_.sizes;
    const bool joins = !sizes.empty() && points <= most_ && sizes.back() <= most_ - points &&
                       (isSmall(points) || isSmall(sizes.back()));
    if (!joins) sizes.push_back(0);
    sizes.back() += points;
    std::fill(groups_.groupOf.begin() + static_cast<std::ptrdiff_t>(first),
              groups_.groupOf.begin() + static_cast<std::ptrdiff_t>(last),
              static_cast<std::uint32_t>(sizes.size() - 1));
  }

  std::uint64_t most_;
  std::vector<std::uint64_t> sums_;
  CellGroups groups_;
};

}  // namespace

CellGroups groupCells(const std::vector<std::uint64_t>& counts, std::uint64_t most) {
  return Grouper(counts, most).run();
}

}  // namespace bspc::tiling
