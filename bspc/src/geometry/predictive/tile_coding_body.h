#pragma once

// How a tile is coded, for one set of vector instructions. To be included by the sources that are
// compiled for one each (tile_coding_portable.cpp, tile_coding_avx2.cpp), and by nothing else.

#include <algorithm>
#include <limits>
#include <memory>

#include "bspc/error.h"
#include "geometry/cell_output.h"
#include "geometry/kd/kd_order.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/predictive/tile_header.h"
#include "geometry/predictive/tree_coder.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Calls of working() between two of the progress callback: some tens of milliseconds.
constexpr unsigned kProgressStep = 1024;

/// The encoder's points, in Morton order.
class SortedPoints {
 public:
  SortedPoints(const TileInput& tile, const std::vector<std::uint32_t>& order,
               const PointProgress& progress)
      : progress_(progress) {
    points_.reserve(order.size());
    for (const std::uint32_t i : order) {
      GridPoint point = tile.points[i];
      for (unsigned k = 0; k < 3; ++k) point[k] -= tile.lower[k];
      points_.push_back(point);
    }
  }

  std::uint32_t countUpper(std::uint32_t first, std::uint32_t count, unsigned axis,
                           std::uint32_t value) const {
    const auto begin = points_.begin() + first;
    const auto reached = std::partition_point(begin, begin + count,
                                              [&](const GridPoint& p) { return p[axis] < value; });
    return static_cast<std::uint32_t>(begin + count - reached);
  }
  void emit(const GridPoint& /*point*/, std::uint32_t count, std::uint32_t /*node*/) {
    done_ += count;
  }
  static void added(std::uint32_t /*parent*/, std::uint32_t /*node*/) {}
  void working(std::uint64_t /*bytes*/) {
    if (++calls_ % kProgressStep == 0 && progress_) progress_(done_);
  }

 private:
  const PointProgress& progress_;
  std::vector<GridPoint> points_;
  std::uint64_t done_ = 0;
  std::uint64_t calls_ = 0;
};

/// The decoder's points, as they come.
class CollectedPoints {
 public:
  CollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : progress_(progress), out_(out), output_(tile, kNoProgress, out) {}

  static std::uint32_t countUpper(std::uint32_t /*first*/, std::uint32_t /*count*/,
                                  unsigned /*axis*/, std::uint32_t /*value*/) {
    return 0;
  }
  void emit(const GridPoint& point, std::uint32_t count, std::uint32_t node) {
    output_.leaf(point, count, cellOf(node));
  }
  void added(std::uint32_t parent, std::uint32_t /*node*/) {
    if (!cells_.empty()) cells_.push_back(cells_[parent]);
  }
  void working(std::uint64_t bytes) {
    output_.checkBytes(bytes + 3 * cells_.size() * sizeof cells_[0]);
    if (++calls_ % kProgressStep == 0 && progress_) progress_(out_.points.size());
  }

  /// From now on points are said to lie in the cells that are undivided now.
  template <class Tree>
  void numberCells(const Tree& tree) {
    cells_.assign(tree.nodes().size(), 0);
    std::uint32_t next = 0;
    tree.forEachUndivided([&](std::uint32_t node) { cells_[node] = next++; });
  }
  std::uint64_t cellOf(std::uint32_t node) const { return cells_.empty() ? 0 : cells_[node]; }
  CellOutput& output() { return output_; }

 private:
  inline static const PointProgress kNoProgress;

  const PointProgress& progress_;
  DecodedTile& out_;
  CellOutput output_;
  std::vector<std::uint32_t> cells_;  ///< of each node; empty unless they are asked for
  std::uint64_t calls_ = 0;
};

/// Bits of the cube around a tile.
inline unsigned gridBits(const GridPoint& extent) {
  return entropy::bitLength(*std::max_element(extent.begin(), extent.end()));
}

/// Input indices in the order of the tree's leaves: x, y and z are halved in turn.
inline std::vector<std::uint32_t> mortonOrder(const TileInput& tile) {
  const std::uint32_t longest = *std::max_element(tile.extent.begin(), tile.extent.end());
  const KdSchedule schedule({longest, longest, longest});
  return KdOrder(tile, schedule).takeOrder();
}

/// The middle of the part of a cell that lies in the tile's box.
inline GridPoint middleOf(const Node& node, const GridPoint& extent) {
  GridPoint middle{};
  for (unsigned k = 0; k < 3; ++k) {
    const auto lower = static_cast<std::uint32_t>(node.lower(k));
    const std::uint64_t last = std::min<std::uint64_t>(node.side() - 1, extent[k] - lower);
    middle[k] = lower + static_cast<std::uint32_t>(last / 2);
  }
  return middle;
}

template <class Tree>
LayerSummary summaryOf(const Tree& tree) {
  LayerSummary summary;
  tree.forEachUndivided([&](std::uint32_t i) {
    ++summary.representatives;
    const auto half = static_cast<std::uint32_t>(tree.nodes()[i].side() / 2);
    summary.spread = std::max(summary.spread, half);
  });
  return summary;
}

inline void checkDepth(unsigned bits, std::uint32_t maxDepth) {
  if (3 * bits <= maxDepth) return;
  throw Error(ErrorCode::LimitExceeded, "a tile has cells of depth " + std::to_string(3 * bits) +
                                            ", more than the limit of " + std::to_string(maxDepth));
}

inline EncodedTile encode(const TileInput& tile, const PointProgress& progress) {
  if (tile.points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Unsupported,
                "method predictive codes at most 4,294,967,295 points in one tile, and this set "
                "has " +
                    std::to_string(tile.points.size()));
  }
  EncodedTile result;
  result.order = mortonOrder(tile);
  SortedPoints points(tile, result.order, progress);
  using Encoding = TreeCoder<entropy::SymbolWriter, SortedPoints>;
  std::unique_ptr<Encoding> tree;
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    if (layer == 0) {
      Features features;
      const unsigned effort = std::clamp(tile.wishes.effort, kLeastEffort, kMostEffort);
      codeFeatures(coder, effort, features);
      // Too large for the stack of a thread.
      const auto count = static_cast<std::uint32_t>(tile.points.size());
      tree =
          std::make_unique<Encoding>(features, tile.extent, gridBits(tile.extent), count, points);
      tree->startSet(count);
    }
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, cellsOfLayer(tile.points.size(), layer, tile.layers));
      result.coarse.push_back(summaryOf(*tree));
    } else {
      tree->finalLayer(coder);
    }
    result.layers.push_back(coder.finish());
  }
  result.version = 0;
  return result;
}

inline DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) {
  if (tile.points > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Corrupt, "a tile of method predictive claims " +
                                        std::to_string(tile.points) +
                                        " points, more than the method allows");
  }
  const unsigned bits = gridBits(tile.extent);
  checkDepth(bits, tile.maxDepth);
  DecodedTile result;
  CollectedPoints points(tile, progress, result);
  using Decoding = TreeCoder<entropy::SymbolReader, CollectedPoints>;
  points.working(sizeof(Decoding));
  std::unique_ptr<Decoding> tree;
  for (unsigned layer = 0; layer < tile.payloads.size(); ++layer) {
    entropy::SymbolReader coder(tile.payloads[layer]);
    if (layer == 0) {
      Features features;
      codeFeatures(coder, 0, features);
      const auto count = static_cast<std::uint32_t>(tile.points);
      tree = std::make_unique<Decoding>(features, tile.extent, bits, count, points);
      tree->startSet(count);
    }
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) points.numberCells(*tree);
    } else {
      tree->finalLayer(coder);
    }
    coder.finish();
  }
  if (tile.payloads.size() == tile.layers) return result;
  // A coarse layer is shown by the middles of its cells.
  tree->forEachUndivided([&](std::uint32_t i) {
    const Node& node = tree->nodes()[i];
    points.output().representative(middleOf(node, tile.extent), node.count, points.cellOf(i));
  });
  return result;
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
