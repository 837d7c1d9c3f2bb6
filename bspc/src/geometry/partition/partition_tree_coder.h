#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"
#include "geometry/cell_growth.h"
#include "geometry/kd/kd_count_model.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/partition/multiplicity_model.h"
#include "geometry/partition/partition_cell.h"

namespace bspc::geometry {

/// The traversal of the axis-aligned partitions that the paper compares with and that tell of a
/// cell's children whether they hold points, not how many; for encoder and decoder alike.
///
/// `Symbols` says which sides are halved and codes the children (occupancy_symbols.h). `Points`:
///   std::uint64_t countLower(first, count, depth)            of the encoder's points
///   GridPoint at(std::uint64_t j)                            the j-th leaf point
///   void emit(const GridPoint&, std::uint64_t count, const PartitionCell&)
///   void cellsInMemory(std::uint64_t bytes)                  throws if they are too many
///   void working()                                           for each cell of a coarse layer;
///   throws to stop
template <class Coder, class Points, class Symbols>
class PartitionTreeCoder {
 public:
  PartitionTreeCoder(const KdSchedule& schedule, Points& points, std::uint64_t count)
      : schedule_(schedule), points_(points) {
    PartitionCell root;
    root.count = count;
    root.known = true;
    root.occupancy = count == 1 ? Occupancy::One : Symbols::kRoot;
    frontier_.push_back(root);
  }

  std::vector<PartitionCell>& frontier() { return frontier_; }
  unsigned depth() const { return depth_; }

  /// One coarse layer: cells are split level by level until there are at least `enough` (the
  /// encoder's wish), and then the points of each are counted.
  void coarseLayer(Coder& coder, std::uint64_t enough) {
    coder_ = &coder;
    std::vector<std::size_t> parents(frontier_.size());
    for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = i;
    const std::vector<PartitionCell> counted = frontier_;
    while (depth_ < schedule_.depth() && coder.bit(deeper_, frontier_.size() < enough)) {
      std::vector<PartitionCell> next;
      std::vector<std::size_t> nextParents;
      const std::uint64_t known = bytesOf(counted) + bytesOf(frontier_) + bytesOf(parents);
      for (std::size_t i = 0; i < frontier_.size(); ++i) {
        makeRoom(points_, next, kMaxChildren, known + bytesOf(nextParents));
        makeRoom(points_, nextParents, kMaxChildren, known + bytesOf(next));
        split(frontier_[i], depth_, next);
        nextParents.resize(next.size(), parents[i]);
      }
      frontier_.swap(next);
      parents.swap(nextParents);
      depth_ += steps(depth_);
    }
    for (std::size_t begin = 0; begin < frontier_.size();) {
      std::size_t end = begin + 1;
      while (end < frontier_.size() && parents[end] == parents[begin]) ++end;
      countCells(begin, end, counted[parents[begin]].count);
      begin = end;
    }
    points_.cellsInMemory(bytesOf(frontier_));
  }

  /// The last layer: every cell is refined down to its points, one after the other, depth first.
  void finalLayer(Coder& coder) {
    coder_ = &coder;
    std::vector<std::pair<PartitionCell, unsigned>> open;
    std::vector<PartitionCell> children;
    for (const PartitionCell& start : frontier_) {
      left_ = start.count;
      open.emplace_back(start, depth_);
      while (!open.empty()) {
        const auto [cell, depth] = open.back();
        open.pop_back();
        if (cell.lone()) {
          place(cell, depth);
        } else if (depth == schedule_.depth()) {
          placeMany(cell);
        } else {
          children.clear();
          split(cell, depth, children);
          for (std::size_t i = children.size(); i > 0; --i) {
            open.emplace_back(children[i - 1], depth + steps(depth));
          }
        }
      }
      if (left_ != 0) {
        throw Error(ErrorCode::Corrupt, "a cell holds fewer points than it was said to");
      }
    }
  }

  /// Side of the part of a cell at `depth` that lies in the tile's box, minus one.
  std::uint32_t lastIndex(const PartitionCell& cell, unsigned depth, unsigned axis) const {
    const std::uint64_t side = std::uint64_t{1} << schedule_.openBits(depth, axis);
    const std::uint32_t room = schedule_.extent()[axis] - cell.lower[axis];
    return room < side - 1 ? room : static_cast<std::uint32_t>(side - 1);
  }

  /// How many steps of the schedule make one level at `depth`.
  unsigned steps(unsigned depth) const {
    if (!Symbols::kAllAxes) return 1;
    unsigned count = 1;
    while (count < 3 && depth + count < schedule_.depth() &&
           openAt(depth + count) == openAt(depth)) {
      ++count;
    }
    return count;
  }

 private:
  static constexpr unsigned kMaxChildren = 8;
  using Children = std::array<PartitionCell, kMaxChildren>;

  unsigned openAt(unsigned depth) const { return schedule_.openBits(depth, schedule_.axis(depth)); }

  /// Appends the children that hold points, lower halves first.
  void split(const PartitionCell& cell, unsigned depth, std::vector<PartitionCell>& out) {
    PartitionCell parent = cell;
    Children children;
    children[0] = cell;
    children[0].known = false;
    unsigned count = 1;
    const unsigned levelSteps = steps(depth);
    for (unsigned s = 0; s < levelSteps; ++s) count = halve(children, count, depth + s);
    if (cell.lone()) {
      const unsigned chosen = loneChild(cell, children, count, depth, levelSteps);
      out.push_back(children[chosen]);
      out.back().occupancy = Occupancy::One;
      out.back().known = true;
      out.back().count = 1;
      return;
    }
    symbols_.code(*coder_, parent, openAt(depth), children.data(), count);
    for (unsigned i = 0; i < count; ++i) {
      if (children[i].occupancy == Occupancy::None) continue;
      if (children[i].occupancy == Occupancy::One) children[i].count = 1;
      out.push_back(children[i]);
    }
  }

  /// Replaces every cell by its halves inside the tile's box.
  unsigned halve(Children& cells, unsigned count, unsigned depth) {
    const unsigned axis = schedule_.axis(depth);
    const std::uint32_t half = std::uint32_t{1} << schedule_.openBits(depth + 1, axis);
    Children halves;
    unsigned n = 0;
    for (unsigned i = 0; i < count; ++i) {
      PartitionCell lower = cells[i];
      PartitionCell upper = cells[i];
      if (Coder::kWriting) {
        lower.count = points_.countLower(cells[i].first, cells[i].count, depth);
        upper.count -= lower.count;
        upper.first += lower.count;
      }
      halves[n++] = lower;
      if (lastIndex(cells[i], depth, axis) < half) continue;
      upper.lower[axis] += half;
      halves[n++] = upper;
    }
    cells = halves;
    return n;
  }

  /// Which child a lone point lies in, as likely as the child is large.
  unsigned loneChild(const PartitionCell& cell, const Children& children, unsigned count,
                     unsigned depth, unsigned levelSteps) {
    unsigned chosen = 0;
    GridPoint point = Coder::kWriting ? points_.at(cell.first) : cell.lower;
    GridPoint corner = cell.lower;
    for (unsigned s = 0; s < levelSteps; ++s) {
      const unsigned axis = schedule_.axis(depth + s);
      const std::uint32_t half = std::uint32_t{1} << schedule_.openBits(depth + s + 1, axis);
      const std::uint32_t last = lastIndex(cell, depth, axis);
      if (last < half) continue;
      const std::uint64_t share = (std::uint64_t{half} << 16) / (std::uint64_t{last} + 1);
      const bool inLower =
          coder_->fixedBit(static_cast<std::uint32_t>(std::min<std::uint64_t>(share, 65535)),
                           point[axis] - cell.lower[axis] < half);
      if (!inLower) corner[axis] += half;
    }
    while (chosen + 1 < count && children[chosen].lower != corner) ++chosen;
    return chosen;
  }

  /// The points of the cells begin … end − 1, which are `sum` together.
  void countCells(std::size_t begin, std::size_t end, std::uint64_t sum) {
    std::uint64_t least = 0;
    for (std::size_t i = begin; i < end; ++i) least += frontier_[i].least();
    if (least > sum) {
      throw Error(ErrorCode::Corrupt, "a cell holds more points than it was said to");
    }
    distribute(begin, end, sum - least);
  }

  /// Shares `excess` out among cells, beyond the fewest points that each can hold.
  void distribute(std::size_t begin, std::size_t end, std::uint64_t excess) {
    if (end - begin == 1 || excess == 0) {
      for (std::size_t i = begin; i < end; ++i) {
        PartitionCell& cell = frontier_[i];
        if (cell.occupancy == Occupancy::One && excess > 0) {
          throw Error(ErrorCode::Corrupt, "a cell of one point holds more");
        }
        cell.count = cell.least() + excess;
        cell.known = true;
      }
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    std::uint64_t lower = 0;
    bool lowerOpen = false;
    bool upperOpen = false;
    for (std::size_t i = begin; i < end; ++i) {
      const PartitionCell& cell = frontier_[i];
      (i < middle ? lowerOpen : upperOpen) |= cell.occupancy != Occupancy::One;
      if (Coder::kWriting && i < middle) lower += cell.count - cell.least();
    }
    if (!lowerOpen || !upperOpen) {
      lower = lowerOpen ? excess : 0;
    } else if (excess == 1) {
      lower = coder_->bit(lastOne_, lower != 0) ? 1 : 0;
    } else {
      const unsigned size = std::min<unsigned>(entropy::bitLength(end - begin),
                                               (1U << KdCountModel::kHistoryBits) - 1);
      lower = counts_.code(*coder_, lower, excess, {size, 1});
    }
    distribute(begin, middle, lower);
    distribute(middle, end, excess - lower);
  }

  /// The place of a lone point in its cell, all places equally likely.
  void place(const PartitionCell& cell, unsigned depth) {
    GridPoint point = Coder::kWriting ? points_.at(cell.first) : cell.lower;
    for (unsigned axis = 0; axis < 3; ++axis) {
      point[axis] = cell.lower[axis] +
                    coder_->uniform(point[axis] - cell.lower[axis], lastIndex(cell, depth, axis));
    }
    take(point, 1, cell);
  }

  /// Equal points.
  void placeMany(const PartitionCell& cell) {
    const std::uint64_t least = cell.least();
    const std::uint64_t count =
        cell.known ? cell.count : least + multiplicity_.code(*coder_, cell.count - least);
    take(cell.lower, count, cell);
  }

  void take(const GridPoint& point, std::uint64_t count, const PartitionCell& cell) {
    if (count > left_) {
      throw Error(ErrorCode::Corrupt, "a cell holds more points than it was said to");
    }
    left_ -= count;
    points_.emit(point, count, cell);
  }

  const KdSchedule& schedule_;
  Points& points_;
  Coder* coder_ = nullptr;
  unsigned depth_ = 0;
  std::uint64_t left_ = 0;  ///< points of the cell of the frontier that are still to come
  std::vector<PartitionCell> frontier_;
  Symbols symbols_;
  KdCountModel counts_;
  MultiplicityModel multiplicity_;
  entropy::AdaptiveBit lastOne_;
  entropy::AdaptiveBit deeper_;
};

}  // namespace bspc::geometry
