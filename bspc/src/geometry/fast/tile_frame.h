#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "bspc/error.h"
#include "geometry/fast/axis_remap.h"
#include "geometry/fast/cell.h"
#include "geometry/output_budget.h"

namespace bspc::geometry::fast {

/// What the layers of a tile have in common: the box of ranks that their coders work in, and the
/// way back to coordinates.
struct TileFrame {
  GridPoint extent{};  ///< greatest rank along each axis (of axes without ranks: coordinate)
  StepScale scale{};
  AxisValues values;  ///< coordinate of each rank; empty: the rank itself

  bool hasRanks() const { return !(values[0].empty() && values[1].empty() && values[2].empty()); }
};

/// Takes decoded points in ranks and appends them to the output as coordinates.
class PointCollector {
 public:
  PointCollector(const TileFrame& frame, const OutputBudget& budget, const PointProgress& progress,
                 DecodedTile& out)
      : frame_(frame), budget_(budget), progress_(progress), out_(out) {}
  /// It keeps a reference, which a temporary function would not outlive.
  PointCollector(const TileFrame& frame, const OutputBudget& budget, PointProgress&& progress,
                 DecodedTile& out) = delete;

  /// Throws Error(Corrupt) if a point lies outside of the tile.
  void append(const GridPoint* points, std::size_t count) {
    std::uint32_t outside = 0;
    for (unsigned k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < count; ++i) outside |= points[i][k] > frame_.extent[k] ? 1 : 0;
    }
    if (outside != 0) failOutside();
    GridPoint* to = grow(count);
    std::copy(points, points + count, to);
    for (unsigned k = 0; k < 3; ++k) {
      const std::vector<std::uint32_t>& values = frame_.values[k];
      if (values.empty()) continue;
      for (std::size_t i = 0; i < count; ++i) to[i][k] = values[to[i][k]];
    }
    report(count);
  }

  /// Coordinates of points that were found to lie inside of the tile.
  void appendInside(const GridPoint* points, std::size_t count) {
    budget_.beforeAppend(out_, count);
    out_.points.insert(out_.points.end(), points, points + count);
    report(count);
  }
  [[noreturn]] static void failOutside() {
    throw Error(ErrorCode::Corrupt, "a point lies outside of its tile: the file is damaged");
  }

  const TileFrame& frame() const { return frame_; }
  const OutputBudget& budget() const { return budget_; }
  const PointProgress& progress() const { return progress_; }

 private:
  static constexpr std::size_t kProgressStep = std::size_t{1} << 16;

  GridPoint* grow(std::size_t count) {
    const std::size_t first = out_.points.size();
    budget_.beforeAppend(out_, count);
    out_.points.resize(first + count);
    return out_.points.data() + first;
  }
  void report(std::size_t count) const {
    const std::size_t now = out_.points.size();
    if (progress_ && (now - count) / kProgressStep != now / kProgressStep) progress_(now);
  }

  const TileFrame& frame_;
  const OutputBudget& budget_;
  const PointProgress& progress_;
  DecodedTile& out_;
};

}  // namespace bspc::geometry::fast
