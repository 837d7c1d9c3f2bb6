#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "geometry/fast/cell.h"
#include "geometry/output_budget.h"

namespace bspc::geometry::fast {

/// Coordinates of points along one axis, relative to the tile's corner.
class AxisColumn {
 public:
  AxisColumn(Span<const GridPoint> points, unsigned axis, std::uint32_t lower)
      : points_(points), axis_(axis), lower_(lower) {}
  std::size_t size() const { return points_.size(); }
  std::uint32_t operator[](std::size_t i) const { return points_[i][axis_] - lower_; }

 private:
  Span<const GridPoint> points_;
  unsigned axis_;
  std::uint32_t lower_;
};

/// The distinct values 0 … extent of an axis, sorted; empty if replacing coordinates by ranks does
/// not pay.
std::vector<std::uint32_t> valuesWorthRanking(const AxisColumn& coordinates, std::uint32_t extent);

/// The ranks of an axis's coordinates among its values.
class AxisRanks {
 public:
  AxisRanks() = default;  ///< coordinates are their own ranks
  AxisRanks(const AxisColumn& coordinates, const std::vector<std::uint32_t>& values);

  /// Of the i-th point, which has this coordinate.
  std::uint32_t rank(std::uint32_t coordinate, std::size_t i) const {
    if (kind_ == Kind::Same) return coordinate;
    return ranks_[kind_ == Kind::OfValue ? coordinate : i];
  }

 private:
  enum class Kind : std::uint8_t { Same, OfValue, OfPoint };
  Kind kind_ = Kind::Same;
  std::vector<std::uint32_t> ranks_;
};

/// Steps between values: whether they are regular enough to speak of a typical one.
bool isRegular(const std::vector<std::uint32_t>& values);

/// Sorted values from 0 to the extent, of each axis that has ranks; the others are empty.
using AxisValues = std::array<std::vector<std::uint32_t>, 3>;

Bytes writeValues(const AxisValues& values);
/// Reads the values of the axes that `ranked` says. Throws Error(Corrupt).
AxisValues readValues(ByteView section, const std::array<bool, 3>& ranked, std::uint64_t maxValues,
                      const GridPoint& extent, const OutputBudget& budget);

}  // namespace bspc::geometry::fast
