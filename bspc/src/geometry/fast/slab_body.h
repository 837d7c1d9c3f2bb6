#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "container/byte_writer.h"
#include "geometry/fast/fit_options.h"
#include "geometry/fast/slab_planner.h"
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

/// Appends points as slabs (docs/format.md, "Method fast"). Returns their indices in the order in
/// which a decoder returns them.
std::vector<std::uint32_t> writeSlabs(const TileFrame& frame, const SetPoints& points,
                                      const SlabOptions& options, container::ByteWriter& out);

/// Decodes `points` points of what writeSlabs() wrote with that kind of (u, v).
void readSlabs(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
               std::uint32_t maxDepth, PointCollector& out);

/// Whether this machine can run the encoder and the decoder that are compiled for AVX2.
bool hasAvx2Slabs();

}  // namespace bspc::geometry::fast
