#pragma once

#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "geometry/fast/tile_frame.h"
#include "geometry/geometry_method.h"

namespace bspc::geometry::fast {

/// In what order the points of a tile stand; layers are strides of it.
enum class Sequence : std::uint8_t { Hilbert = 0, Input = 1 };

/// What stands in front of the coarsest layer and holds for all.
struct TileHeader {
  Sequence sequence = Sequence::Hilbert;
  unsigned ratioBits = 0;  ///< see LayerStrides; only of tiles with several layers
  TileFrame frame;
};

/// The points of a tile relative to its corner, replaced by ranks along the axes where that pays.
/// Computed anew whenever they are asked for, so that they take no memory.
class RankedPoints {
 public:
  explicit RankedPoints(const TileInput& tile);

  std::size_t size() const { return points_.size(); }
  GridPoint operator[](std::size_t i) const {
    const GridPoint& p = points_[i];
    return {ranks_[0].rank(p[0] - lower_[0], i), ranks_[1].rank(p[1] - lower_[1], i),
            ranks_[2].rank(p[2] - lower_[2], i)};
  }
  const TileHeader& header() const { return header_; }
  /// Another guess at the scale: from all axes with ranks, whether their steps are regular or not.
  const StepScale& otherScale() const { return otherScale_; }

 private:
  Span<const GridPoint> points_;
  GridPoint lower_;
  std::array<AxisRanks, 3> ranks_;
  TileHeader header_;
  StepScale otherScale_{};
};

void writeHeader(container::ByteWriter& out, const TileHeader& header, unsigned layers);
/// Throws Error(Corrupt).
TileHeader readHeader(container::ByteReader& in, const TileToDecode& tile,
                      const OutputBudget& budget);

}  // namespace bspc::geometry::fast
