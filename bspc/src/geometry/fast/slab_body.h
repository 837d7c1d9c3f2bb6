#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "geometry/fast/slab_planner.h"
#include "geometry/fast/surface_fit.h"
#include "geometry/fast/tile_frame.h"

namespace bspc::geometry::fast {

/// How the encoder goes about a body of slabs.
struct SlabOptions {
  PlanOptions plan;
  FitOptions fit;
  bool uvTree = false;       ///< (u, v) as a tree with contexts rather than gaps along a curve
  unsigned extraLevels = 0;  ///< of that tree, 0 … 6
};

/// A set of points and the order in which a decoder returns them.
struct CodedSet {
  Bytes bytes;
  std::vector<std::uint32_t> order;
};

/// Codes points as slabs (docs/format.md, "Method fast").
CodedSet writeSlabs(const TileFrame& frame, std::vector<TilePoint> points,
                    const SlabOptions& options);

/// Decodes `points` points of what writeSlabs() wrote with that kind of (u, v).
void readSlabs(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
               std::uint32_t maxDepth, PointCollector& out);

}  // namespace bspc::geometry::fast
