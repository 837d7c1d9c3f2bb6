#pragma once

// The encoder of slabs, for one instruction set. To be included by the sources that are compiled
// for one each (slab_writer_portable.cpp, slab_writer_avx2.cpp), and by nothing else.

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "container/byte_writer.h"
#include "entropy/lane_set.h"
#include "entropy/symbol_coder.h"
#include "geometry/fast/chunk_coder.h"
#include "geometry/fast/slab_body.h"
#include "geometry/fast/slab_tree.h"
#include "geometry/fast/sorted_slab.h"
#include "geometry/fast/surface_fit.h"
#include "geometry/fast/uv_tree.h"

namespace bspc::geometry::fast {
inline namespace BSPC_LANE_SET {

/// Estimates look at every so many-th chunk of a large slab.
constexpr std::size_t kEstimateStep = 4;
constexpr float kSlabBits = 24;
constexpr std::size_t kSizesBytes = 64;  ///< more than the sizes of all sections take

inline SurfaceHistory startOf(const SlabFrame& frame) {
  const auto middle = [&frame](unsigned k) { return (std::uint32_t{1} << frame.levels[k]) / 2; };
  return SurfaceHistory(middle(0), middle(1), middle(2));
}

/// The chunk of a slab that begins at point `first`; where its points came from goes to `order`,
/// unless that is null.
inline void loadChunk(const SortedSlab& slab, std::size_t first, Chunk& chunk,
                      std::uint32_t* order) {
  const std::size_t count = std::min(kChunkPoints, slab.size() - first);
  chunk.count = count;
  std::uint64_t before = first > 0 ? slab.code(first - 1) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t code = slab.code(first + i);
    chunk.gaps[i] = code - before;
    before = code;
    const TilePoint& p = slab.point(first + i);
    chunk.u[i] = slab.coordinate(p, 0);
    chunk.v[i] = slab.coordinate(p, 1);
    chunk.w[i] = slab.coordinate(p, 2);
    if (order != nullptr) order[i] = p.index;
  }
  if (slab.frame().cutBits() == 0) return;
  for (std::size_t i = 0; i < count; ++i) chunk.cutOff[i] = slab.cutOff(slab.point(first + i));
}

inline void remember(const Chunk& chunk, SurfaceHistory& history) {
  if (chunk.surface.mode == SurfaceMode::Delta) {
    const std::size_t last = chunk.count - 1;
    history.passThrough(chunk.u[last], chunk.v[last], chunk.w[last]);
  } else {
    history.remember(chunk.footprint, chunk.surface);
  }
}

/// The encoder's side of codeSlabTree(), once the slabs themselves are coded.
class PlannedSlabs {
 public:
  using Node = std::uint32_t;
  explicit PlannedSlabs(const std::vector<PlanNode>& nodes) : nodes_(nodes) {}

  bool isSlab(Node n) const { return nodes_[n].slab; }
  unsigned heightAxis(Node n) const { return nodes_[n].heightAxis; }
  std::uint64_t countLower(Node n) const {
    if (!nodes_[n].has(0)) return 0;
    const PlanNode& lower = nodes_[nodes_[n].child[0]];
    return lower.last - lower.first;
  }
  Node child(Node n, unsigned half) const { return nodes_[n].child[half]; }
  void slab(Node n, const Cell& /*cell*/, std::uint64_t /*points*/, unsigned /*axis*/) {
    order_.push_back(n);
  }
  const std::vector<Node>& order() const { return order_; }

 private:
  const std::vector<PlanNode>& nodes_;
  std::vector<Node> order_;
};

class SlabWriter {
 public:
  SlabWriter(const TileFrame& frame, const SlabOptions& options, std::size_t points)
      : frame_(frame), options_(options), out_(points), chunks_(out_), order_(points) {
    if (options.uvTree) {
      uvTree_ = std::make_unique<Tree>(uvCoder_, out_.raw, options.extraLevels);
    }
  }

  std::vector<std::uint32_t> write(const SetPoints& points, container::ByteWriter& out) {
    SlabPlanner planner(frame_.scale, options_.plan,
                        [this](const Cell& cell, const TilePoint* p, std::uint32_t n,
                               unsigned axis) { return estimate(cell, p, n, axis); });
    planner.plan(points, rootCell(frame_.extent));
    BitWriter tree;
    PlannedSlabs slabs(planner.nodes());
    codeSlabTree(tree, slabs, 0, rootCell(frame_.extent), points.size(), frame_.scale);
    for (const std::uint32_t id : slabs.order()) {
      const PlanNode& node = planner.nodes()[id];
      writeSlab(node.cell, planner.points().data() + node.first, node.last - node.first,
                node.heightAxis);
    }
    assemble(tree.finish(), points.size(), out);
    return std::move(order_);
  }

 private:
  using Tree = UvTree<entropy::SymbolWriter, BitWriter>;

  float estimate(const Cell& cell, const TilePoint* points, std::uint32_t count,
                 unsigned heightAxis) {
    slab_.sort(cell, frame_.scale, points, count, heightAxis);
    SurfaceHistory history = startOf(slab_.frame());
    const std::size_t step = kChunkPoints * (count > 3 * kChunkPoints ? kEstimateStep : 1);
    float bits = 0;
    std::size_t seen = 0;
    std::uint32_t lastHeight = (std::uint32_t{1} << slab_.frame().levels[2]) / 2;
    for (std::size_t first = 0; first < count; first += step) {
      if (first > 0) lastHeight = slab_.coordinate(slab_.point(first - 1), 2);
      loadChunk(slab_, first, chunk_, nullptr);
      bits += chooseGapClass(chunk_) + fitSurface(chunk_, history, lastHeight, options_.fit);
      seen += chunk_.count;
      remember(chunk_, history);
    }
    return bits * static_cast<float>(count) / static_cast<float>(seen) + kSlabBits;
  }

  void writeSlab(const Cell& cell, const TilePoint* points, std::uint32_t count,
                 unsigned heightAxis) {
    slab_.sort(cell, frame_.scale, points, count, heightAxis);
    const SlabFrame& frame = slab_.frame();
    if (options_.uvTree && frame.levels[0] + frame.levels[1] > 0) {
      plane_.resize(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        const TilePoint& p = slab_.point(i);
        plane_[i] = {{slab_.coordinate(p, 0), slab_.coordinate(p, 1)}};
      }
      uvTree_->code(frame, frame_.scale, plane_);
    }
    SurfaceHistory history = startOf(frame);
    std::uint32_t lastHeight = (std::uint32_t{1} << frame.levels[2]) / 2;
    for (std::size_t first = 0; first < count; first += kChunkPoints) {
      loadChunk(slab_, first, chunk_, order_.data() + written_);
      written_ += chunk_.count;
      if (!options_.uvTree) {
        chooseGapClass(chunk_);
        chunks_.codeGaps(chunk_);
      }
      fitSurface(chunk_, history, lastHeight, options_.fit);
      setResiduals(chunk_, lastHeight);
      chunks_.codeHeights(chunk_, history);
      chunks_.codeCutOff(chunk_, frame.cutBits());
      lastHeight = chunk_.w[chunk_.count - 1];
      remember(chunk_, history);
    }
  }

  void assemble(const Bytes& tree, std::size_t points, container::ByteWriter& body) {
    const unsigned lanes = ransLanes(points);
    BitWriter tables;
    const auto code = [&tables](const RansWriter& stream, const DefaultTables& defaults,
                                unsigned count, unsigned streamLanes) {
      return stream.finish(writeTables(tables, stream.counts(count), defaults), streamLanes);
    };
    const Bytes gaps = options_.uvTree
                           ? uvCoder_.finish()
                           : code(out_.gaps, defaultGapTables(), kGapClasses.tables(), lanes);
    const Bytes residuals =
        code(out_.residuals, defaultResidualTables(), kResidualClasses.tables(), lanes);
    const Bytes fields = code(out_.fields, defaultFieldTables(), kFields, 1);
    const Bytes head = tables.finish();
    const Bytes raw = out_.raw.finish();
    body.reserve(head.size() + tree.size() + gaps.size() + residuals.size() + fields.size() +
                 raw.size() + kSizesBytes);
    for (const Bytes* section : {&head, &tree, &gaps, &residuals, &fields}) {
      body.varint(section->size());
    }
    for (const Bytes* section : {&head, &tree, &gaps, &residuals, &fields}) {
      body.bytes(*section);
    }
    body.bytes(raw);
  }

  const TileFrame& frame_;
  SlabOptions options_;
  ChunkWriter out_;
  ChunkCoder<ChunkWriter> chunks_;
  entropy::SymbolWriter uvCoder_;
  std::unique_ptr<Tree> uvTree_;
  SortedSlab slab_;
  Chunk chunk_{};
  std::vector<PlanePoint> plane_;
  std::vector<std::uint32_t> order_;
  std::size_t written_ = 0;
};

inline std::vector<std::uint32_t> write(const TileFrame& frame, const SetPoints& points,
                                        const SlabOptions& options, container::ByteWriter& out) {
  const auto writer = std::make_unique<SlabWriter>(frame, options, points.size());
  return writer->write(points, out);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::fast
