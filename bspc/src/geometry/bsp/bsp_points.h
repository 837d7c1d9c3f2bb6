#pragma once

#include <cstdint>
#include <vector>

#include "geometry/bsp/bsp_cell.h"
#include "geometry/bsp/cut_parameters.h"
#include "geometry/cell_output.h"
#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// The encoder's points, brought into the order of the leaves as cells are cut.
class BspSortedPoints {
 public:
  /// Thrown where a cell's box has lost a point to the rounding of vertices.
  struct Lost {};

  BspSortedPoints(const TileInput& tile, const PointProgress& progress);

  std::uint64_t partition(const BspCell& cell, const CutPlane& plane);
  WantedDirection wantedDirection(const BspCell& cell, const LocalFrame& frame) const;
  double wantedAlpha(const BspCell& cell, const LocalFrame& frame,
                     const IntegerVector& normal) const;
  GridPoint at(std::uint64_t j) const { return points_[static_cast<std::size_t>(j)]; }
  /// Sorts the cell's points by place, and counts those of each.
  void tally(const BspCell& cell, const GridPoint* places, unsigned count, std::uint64_t* points);
  [[noreturn]] static void lost() { throw Lost(); }

  void emit(const GridPoint& point, std::uint64_t count, const BspCell& cell);
  static void cellsInMemory(std::uint64_t /*bytes*/) {}
  static void working() {}

  /// Greatest distance along an axis of the points of the cells to the middles of their boxes.
  std::uint32_t spread(const std::vector<BspCell>& cells) const;

  std::vector<std::uint32_t> takeOrder() { return std::move(order_); }
  /// Where points stand that were not coded exactly, all of them in order; empty if all were.
  std::vector<GridPoint> takeDecoded(bool lossy) {
    return lossy ? std::move(decoded_) : std::vector<GridPoint>();
  }

 private:
  Span<const GridPoint> pointsOf(const BspCell& cell) const {
    return Span<const GridPoint>(points_).subspan(static_cast<std::size_t>(cell.first),
                                                  static_cast<std::size_t>(cell.count));
  }

  const PointProgress& progress_;
  bool lossy_;
  std::vector<GridPoint> points_;
  std::vector<std::uint32_t> order_;
  std::vector<GridPoint> decoded_;
  std::uint64_t done_ = 0;
  std::uint64_t nextReport_ = 0;
};

/// The decoder's points, as they come.
class BspCollectedPoints {
 public:
  BspCollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : output_(tile, progress, out) {}

  static std::uint64_t partition(const BspCell& /*cell*/, const CutPlane& /*plane*/) { return 0; }
  static WantedDirection wantedDirection(const BspCell& /*cell*/, const LocalFrame& /*frame*/) {
    return {};
  }
  static double wantedAlpha(const BspCell& /*cell*/, const LocalFrame& /*frame*/,
                            const IntegerVector& /*normal*/) {
    return 0;
  }
  static GridPoint at(std::uint64_t /*j*/) { return {}; }
  static void tally(const BspCell& /*cell*/, const GridPoint* /*places*/, unsigned /*count*/,
                    std::uint64_t* /*points*/) {}
  static void lost() {}
  void emit(const GridPoint& point, std::uint64_t count, const BspCell& cell) {
    output_.leaf(point, count, cell.id);
  }
  void cellsInMemory(std::uint64_t bytes) { output_.hold(bytes); }
  void working() { output_.working(); }
  CellOutput& output() { return output_; }

 private:
  CellOutput output_;
};

}  // namespace bspc::geometry
