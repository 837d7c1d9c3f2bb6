#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"
#include "geometry/cell_growth.h"
#include "geometry/geometry_method.h"
#include "geometry/kd/kd_count_model.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/stop_rule.h"

namespace bspc::geometry {

/// A cell of the kd-tree: a box whose sides are powers of two, and the points in it.
struct KdCell {
  GridPoint lower{};
  std::uint16_t history = 0;  ///< see KdCountModel::Context
  std::uint16_t depth = 0;
  std::uint64_t count = 0;
  std::uint64_t first = 0;  ///< number of points in the leaves before it
  std::uint64_t id = 0;     ///< of its ancestor in the layer that cell ids are asked of
};

/// The kd-tree traversal, for encoder and decoder alike.
///
/// `Points` answers the encoder's questions and takes the decoder's points:
///   std::uint64_t countLower(const KdCell&, unsigned depth)   points in the lower half
///   GridPoint at(std::uint64_t j)                             the j-th leaf point
///   void emit(const GridPoint&, std::uint64_t count, const KdCell&)
///   void emitUndivided(const GridPoint&, const KdCell&)       a cell that a lossy coding stops at
///   void cellsInMemory(std::uint64_t bytes)                   throws if they are too many
///   void working()                                            for each cell of a coarse layer;
///   throws to stop
/// On the decoder's side the first two return anything; on the encoder's emit() may do nothing.
template <class Coder, class Points>
class KdTreeCoder {
 public:
  KdTreeCoder(const KdSchedule& schedule, Points& points, std::uint64_t count,
              const StopRule& stop = {})
      : schedule_(schedule), points_(points), stop_(stop), lossy_(stop.lossy()) {
    if (count > 0) {
      KdCell root;
      root.count = count;
      frontier_.push_back(root);
    }
  }

  /// The stop rule; in front of the first layer, in streams of version 1 only.
  void head(Coder& coder) {
    stop_.code(coder);
    lossy_ = stop_.lossy();
  }

  std::vector<KdCell>& frontier() { return frontier_; }

  /// One coarse layer: all cells are split level by level until at least `enough` cells hold
  /// points (the encoder's wish; the stream says after each level whether the layer goes on).
  void coarseLayer(Coder& coder, std::uint64_t enough) {
    coder_ = &coder;
    while (depth_ < schedule_.depth() && coder.bit(deeper_, frontier_.size() < enough)) {
      std::vector<KdCell> next;
      for (const KdCell& cell : frontier_) {
        makeRoom(points_, next, 2, bytesOf(frontier_));
        if (stops(cell)) {
          next.push_back(cell);
        } else {
          splitInto(cell, next);
        }
      }
      frontier_.swap(next);
      ++depth_;
    }
    points_.cellsInMemory(bytesOf(frontier_));
  }

  /// The last layer: every cell is refined down to its points, one after the other.
  void finalLayer(Coder& coder) {
    coder_ = &coder;
    for (const KdCell& cell : frontier_) refine(cell, cell.depth);
  }

  /// Side of the part of a cell at `depth` that lies in the tile's box, minus one.
  std::uint32_t lastIndex(const KdCell& cell, unsigned depth, unsigned axis) const {
    const std::uint64_t side = std::uint64_t{1} << schedule_.openBits(depth, axis);
    const std::uint32_t room = schedule_.extent()[axis] - cell.lower[axis];
    return room < side - 1 ? room : static_cast<std::uint32_t>(side - 1);
  }

  /// The middle of the part of a cell that lies in the tile's box.
  GridPoint middle(const KdCell& cell) const {
    GridPoint point = cell.lower;
    for (unsigned k = 0; k < 3; ++k) point[k] += lastIndex(cell, cell.depth, k) / 2;
    return point;
  }

 private:
  struct Halves {
    KdCell lower;
    KdCell upper;
  };

  bool stops(const KdCell& cell) const { return lossy_ && stop_.stops(cell.count, cell.depth); }

  Halves split(const KdCell& cell, unsigned depth) {
    const unsigned axis = schedule_.axis(depth);
    const unsigned open = schedule_.openBits(depth + 1, axis);
    const std::uint32_t half = std::uint32_t{1} << open;
    const std::uint32_t last = lastIndex(cell, depth, axis);
    std::uint64_t inLower = cell.count;
    Halves halves{cell, cell};
    halves.lower.depth = halves.upper.depth = static_cast<std::uint16_t>(depth + 1);
    if (last >= half) {  // otherwise the upper half lies outside the box: nothing to code
      inLower = Coder::kWriting ? points_.countLower(cell, depth) : 0;
      if (cell.count == 1) {
        inLower = singleSide(inLower != 0, half, last) ? 1 : 0;
      } else {
        inLower = counts_.code(*coder_, inLower, cell.count, {cell.history, open + 1});
        constexpr unsigned kMask = (1U << KdCountModel::kHistoryBits) - 1;
        const unsigned oneSided = inLower == 0 || inLower == cell.count ? 1U : 0U;
        halves.lower.history = halves.upper.history =
            static_cast<std::uint16_t>(((unsigned{cell.history} << 1) | oneSided) & kMask);
      }
      halves.upper.lower[axis] += half;
    }
    halves.lower.count = inLower;
    halves.upper.count = cell.count - inLower;
    halves.upper.first += inLower;
    return halves;
  }

  /// Which half a lone point lies in, as likely as that half is large.
  bool singleSide(bool inLower, std::uint32_t half, std::uint32_t last) {
    const std::uint64_t all = std::uint64_t{last} + 1;
    if (all == 2 * std::uint64_t{half}) return coder_->raw(inLower ? 1 : 0, 1) != 0;
    const std::uint64_t share = (std::uint64_t{half} << 16) / all;
    return coder_->fixedBit(static_cast<std::uint32_t>(share < 65535 ? share : 65535), inLower);
  }

  void splitInto(const KdCell& cell, std::vector<KdCell>& next) {
    const Halves halves = split(cell, depth_);
    if (halves.lower.count > 0) next.push_back(halves.lower);
    if (halves.upper.count > 0) next.push_back(halves.upper);
  }

  // Recursion is bounded by the schedule's depth, 96.
  void refine(const KdCell& cell, unsigned depth) {
    if (stops(cell)) {
      points_.emitUndivided(middle(cell), cell);
    } else if (cell.count == 1 && !stop_.level) {
      place(cell, depth);
    } else if (depth == schedule_.depth()) {
      points_.emit(cell.lower, cell.count, cell);
    } else {
      const Halves halves = split(cell, depth);
      if (halves.lower.count > 0) refine(halves.lower, depth + 1);
      if (halves.upper.count > 0) refine(halves.upper, depth + 1);
    }
  }

  /// The place of a lone point in its cell, all places equally likely.
  void place(const KdCell& cell, unsigned depth) {
    GridPoint point = Coder::kWriting ? points_.at(cell.first) : GridPoint{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned open = schedule_.openBits(depth, axis);
      if (open == 0) {
        point[axis] = cell.lower[axis];
        continue;
      }
      const std::uint32_t last = lastIndex(cell, depth, axis);
      const std::uint32_t offset = point[axis] - cell.lower[axis];
      const bool whole = (std::uint64_t{last} + 1) >> open != 0;
      point[axis] =
          cell.lower[axis] + (whole ? static_cast<std::uint32_t>(coder_->wide(offset, open))
                                    : coder_->uniform(offset, last));
    }
    points_.emit(point, 1, cell);
  }

  const KdSchedule& schedule_;
  Points& points_;
  StopRule stop_;
  bool lossy_;
  Coder* coder_ = nullptr;
  unsigned depth_ = 0;
  std::vector<KdCell> frontier_;
  KdCountModel counts_;
  entropy::AdaptiveBit deeper_;
};

}  // namespace bspc::geometry
