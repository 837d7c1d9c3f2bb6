#pragma once

#include <vector>

#include "bspc/span.h"
#include "geometry/fast/tile_header.h"
#include "geometry/fast/tile_sequence.h"

namespace bspc::geometry::fast {

/// One layer of a tile whose sequence is the input's; the points of coarser layers are known.
Bytes writeInInputOrder(const RankedPoints& ranked, const LayerStrides& strides, unsigned layer);

/// Decodes a layer: `points` are those of the coarser layers in their order, and become those of
/// this one and them.
void readInInputOrder(ByteView payload, const LayerStrides& strides, unsigned layer,
                      const GridPoint& extent, const TileToDecode& limits,
                      const PointProgress& progress, std::vector<GridPoint>& points);

/// Bits a point that the input's order promises, by a sample of consecutive ones.
double estimateInInputOrder(const RankedPoints& ranked);

}  // namespace bspc::geometry::fast
