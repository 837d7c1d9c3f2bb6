#pragma once

#include <cstdint>

#include "geometry/output_budget.h"

namespace bspc::geometry {

/// Where a decoder's points go, with counts and cell ids as they are asked for.
class CellOutput {
 public:
  CellOutput(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : tile_(tile),
        progress_(progress),
        out_(out),
        budget_(tile),
        ownCells_(tile.cellLevel && *tile.cellLevel + 1 == tile.layers) {}

  /// `count` points at one place, the leaf of a cell that belongs to cell `id` of the layer that
  /// ids are asked of; of the last layer every leaf is a cell.
  void leaf(const GridPoint& point, std::uint64_t count, std::uint64_t id) {
    if (ownCells_) id = leaves_++;
    budget_.beforeAppend(out_, count);
    for (std::uint64_t left = count; left > 0; --left) append(point, 1, id);
  }
  void representative(const GridPoint& point, std::uint64_t count, std::uint64_t id) {
    budget_.beforeAppend(out_);
    append(point, count, id);
  }
  /// Says how much memory cells take from now on; throws Error(LimitExceeded) if that is more than
  /// the call may have.
  void hold(std::uint64_t bytes) { budget_.hold(out_, bytes); }
  /// To be called for each cell that is divided before there are points.
  void working() {
    if (++cells_ % kProgressCells == 0 && progress_) progress_(out_.points.size());
  }

 private:
  /// Points between two calls of the progress callback.
  static constexpr std::uint64_t kProgressStep = 1U << 14;
  static constexpr std::uint64_t kProgressCells = 1U << 12;

  void append(const GridPoint& point, std::uint64_t count, std::uint64_t id) {
    out_.points.push_back(point);
    if (tile_.wantCounts) out_.counts.push_back(count);
    if (tile_.cellLevel) out_.cellIds.push_back(id);
    if (progress_ && out_.points.size() % kProgressStep == 0) progress_(out_.points.size());
  }

  const TileToDecode& tile_;
  const PointProgress& progress_;
  DecodedTile& out_;
  OutputBudget budget_;
  bool ownCells_;  ///< ids are asked of the last layer
  std::uint64_t leaves_ = 0;
  std::uint64_t cells_ = 0;
};

/// Cells that a coarse layer is to have: a quarter of the next finer one's, the last being the
/// points.
inline std::uint64_t cellsOfLayer(std::uint64_t points, unsigned layer, unsigned layers) {
  const unsigned shift = 2 * (layers - 1 - layer);
  return shift < 64 ? std::max<std::uint64_t>(points >> shift, 1) : 1;
}

}  // namespace bspc::geometry
