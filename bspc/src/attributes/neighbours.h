#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/morton.h"
#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// The points of a tile in the order in which the full methods code them: known points first, then
/// new ones, both along the Morton curve. The place in that order is a point's rank.
struct RankedPoints {
  std::size_t known = 0;
  unsigned bits = 0;  ///< of the greatest coordinate
  unsigned cut = 0;   ///< bits that positions are without
  std::vector<std::uint32_t> indexOfRank;
  /// By rank; coordinates of more than 30 bits without the lowest, so that squared distances fit
  /// 64 bits.
  std::vector<std::array<std::int32_t, 3>> positions;
  std::vector<std::uint32_t> rankAlongCurve;  ///< ranks of all points along the Morton curve
  std::vector<MortonEntry> curve;             ///< all points along it

  std::size_t size() const { return positions.size(); }

  std::uint64_t squaredDistance(std::uint32_t a, std::uint32_t b) const {
    std::uint64_t sum = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const std::int64_t d = std::int64_t{positions[a][k]} - positions[b][k];
      sum += static_cast<std::uint64_t>(d * d);
    }
    return sum;
  }
};

RankedPoints rankPoints(Span<const GridPoint> points, std::size_t known);

/// For each new point the points of lower rank that lie nearest: of those in the 27 cells around
/// it, at most the last 24 of each cell.
class NeighbourTable {
 public:
  static constexpr unsigned kMaxNeighbours = 20;

  /// The `limit` ≤ 20 nearest, in cells of `mean` points.
  NeighbourTable(const RankedPoints& points, unsigned limit, unsigned mean);

  /// Ranks of the neighbours of the point of that rank (at least points.known), nearest first, of
  /// equally near ones the lower rank first.
  Span<const std::uint32_t> of(std::size_t rank) const {
    const std::size_t i = rank - known_;
    return {ranks_.data() + i * limit_, counts_[i]};
  }

  /// Bytes that a table takes, and making it.
  static std::uint64_t bytesFor(std::uint64_t points, unsigned limit) {
    constexpr std::uint64_t kWhileMade = 32;
    return points * (4ULL * limit + 1 + kWhileMade);
  }

 private:
  std::size_t known_;
  unsigned limit_;
  std::vector<std::uint32_t> ranks_;
  std::vector<std::uint8_t> counts_;
};

}  // namespace bspc::attributes
