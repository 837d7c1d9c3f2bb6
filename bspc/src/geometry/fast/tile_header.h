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

/// The tile's points relative to its corner, by axis, replaced by ranks where that pays.
struct RankedPoints {
  TileHeader header;
  std::vector<std::uint32_t> coordinates[3];
  /// Another guess at the scale: from all axes with ranks, whether their steps are regular or not.
  StepScale otherScale{};
};
RankedPoints rankPoints(const TileInput& tile);

void writeHeader(container::ByteWriter& out, const TileHeader& header, unsigned layers);
/// Throws Error(Corrupt).
TileHeader readHeader(container::ByteReader& in, const TileToDecode& tile,
                      const OutputBudget& budget);

}  // namespace bspc::geometry::fast
