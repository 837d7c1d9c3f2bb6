#pragma once

// How a tile is coded, for one set of vector instructions. To be included by the sources that are
// compiled for one each (tile_coding_portable.cpp, tile_coding_avx2.cpp), and by nothing else.

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "bspc/error.h"
#include "geometry/cell_output.h"
#include "geometry/kd/kd_order.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/predictive/set_coder.h"
#include "geometry/predictive/tile_header.h"
#include "geometry/predictive/tile_structure.h"
#include "geometry/predictive/tree_coder.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Calls of working(), each after a cell of some tens of points, between two of the progress
/// callback: some tens of milliseconds.
constexpr unsigned kProgressStep = 32;

/// Input indices in the order of the tree's leaves: x, y and z are halved in turn.
inline std::vector<std::uint32_t> mortonOrder(Span<const GridPoint> points,
                                              const GridPoint& extent) {
  const std::uint32_t longest = *std::max_element(extent.begin(), extent.end());
  TileInput tile;
  tile.points = points;
  tile.extent = extent;
  return KdOrder(tile, KdSchedule({longest, longest, longest})).takeOrder();
}

/// The encoder's points, from the tile's lower corner, and those of them that the tree is to code
/// next, in Morton order.
class SortedPoints {
 public:
  SortedPoints(const TileInput& tile, const PointProgress& progress)
      : progress_(progress), extent_(tile.extent) {
    all_.assign(tile.points.begin(), tile.points.end());
    for (GridPoint& p : all_) {
      for (unsigned k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    }
    order_.reserve(all_.size());
  }

  const std::vector<GridPoint>& all() const { return all_; }
  const GridPoint& input(std::uint32_t index) const { return all_[index]; }

  void select(std::vector<std::uint32_t> indices) {
    std::vector<GridPoint> chosen;
    chosen.reserve(indices.size());
    for (const std::uint32_t i : indices) chosen.push_back(all_[i]);
    const std::vector<std::uint32_t> sequence = mortonOrder(chosen, extent_);
    sorted_.clear();
    indices_.clear();
    for (const std::uint32_t i : sequence) {
      sorted_.push_back(chosen[i]);
      indices_.push_back(indices[i]);
    }
    emitted_ = 0;
  }

  std::uint32_t countUpper(std::uint32_t first, std::uint32_t count, unsigned axis,
                           std::uint32_t value) const {
    const auto begin = sorted_.begin() + first;
    const auto reached = std::partition_point(begin, begin + count,
                                              [&](const GridPoint& p) { return p[axis] < value; });
    return static_cast<std::uint32_t>(begin + count - reached);
  }
  void emit(const GridPoint& /*point*/, std::uint32_t count, std::uint32_t /*node*/) {
    for (; count > 0; --count) order_.push_back(indices_[emitted_++]);
  }
  void append(const GridPoint& /*point*/, std::uint32_t index) { order_.push_back(index); }
  std::size_t size() const { return order_.size(); }
  const GridPoint& at(std::size_t i) const { return all_[order_[i]]; }
  std::vector<std::uint32_t> takeOrder() { return std::move(order_); }

  static void added(std::uint32_t /*parent*/, std::uint32_t /*node*/) {}
  void working(std::uint64_t /*bytes*/) {
    if (++calls_ % kProgressStep == 0 && progress_) progress_(order_.size());
  }

 private:
  const PointProgress& progress_;
  GridPoint extent_;
  std::vector<GridPoint> all_;
  std::vector<GridPoint> sorted_;       ///< those for the tree
  std::vector<std::uint32_t> indices_;  ///< of them in all_
  std::size_t emitted_ = 0;             ///< how many of them the tree has coded
  std::vector<std::uint32_t> order_;    ///< indices in all_ of all that are coded
  std::uint64_t calls_ = 0;
};

/// The decoder's points, as they come.
class CollectedPoints {
 public:
  CollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : progress_(progress), out_(out), output_(tile, progress, out) {}

  static std::uint32_t countUpper(std::uint32_t /*first*/, std::uint32_t /*count*/,
                                  unsigned /*axis*/, std::uint32_t /*value*/) {
    return 0;
  }
  static void select(const std::vector<std::uint32_t>& /*indices*/) {}
  static GridPoint input(std::uint32_t /*index*/) { return {}; }
  void emit(const GridPoint& point, std::uint32_t count, std::uint32_t node) {
    output_.leaf(point, count, cellOf(node));
  }
  /// A point that is no tree's.
  void append(const GridPoint& point, std::uint32_t /*index*/) { output_.leaf(point, 1, 0); }
  std::size_t size() const { return out_.points.size(); }
  const GridPoint& at(std::size_t i) const { return out_.points[i]; }
  void added(std::uint32_t parent, std::uint32_t /*node*/) {
    if (!cells_.empty()) cells_.push_back(cells_[parent]);
  }
  void working(std::uint64_t bytes) {
    output_.hold(bytes + 3 * cells_.size() * sizeof cells_[0]);
    if (++calls_ % kProgressStep == 0 && progress_) progress_(out_.points.size());
  }

  /// From now on points are said to lie in the cells that are undivided now.
  template <class Tree>
  void numberCells(const Tree& tree) {
    cells_.assign(tree.nodes().size(), 0);
    std::uint32_t next = 0;
    tree.forEachUndivided([&](std::uint32_t node) { cells_[node] = next++; });
  }
  /// All points lie in the one cell that there is.
  void forgetCells() { cells_.clear(); }
  std::uint64_t cellOf(std::uint32_t node) const { return cells_.empty() ? 0 : cells_[node]; }
  CellOutput& output() { return output_; }

 private:
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

/// Codes the frequencies of the lattices that axes have.
template <class Coder>
void codePhases(Coder& coder, const Features& features, const TileStructure& structure,
                PhaseHistograms& phases) {
  constexpr std::uint32_t kRarely = 2048;  // of 65536
  if (!features.has(Features::kPhase)) return;
  for (unsigned k = 0; k < 3; ++k) {
    const std::uint32_t frequency = structure.phases[k];
    if (!coder.fixedBit(kRarely, frequency != 0)) continue;
    phases[k] = PhaseHistogram(static_cast<std::uint32_t>(coder.wide(frequency, 32)));
  }
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

inline unsigned effortOf(const TileInput& tile) {
  return std::clamp(tile.wishes.effort, kLeastEffort, kMostEffort);
}

/// Whether the number of the effort says what the features are.
inline bool isOfEffort(const Features& features, const TileInput& tile) {
  return tile.wishes.features == nullptr &&
         features.cellPoints == featuresOf(effortOf(tile)).cellPoints;
}

/// With the structure that was found, or part of it.
inline EncodedTile encodeWith(const Features& features, const TileStructure& structure,
                              const TileInput& tile, const PointProgress& progress) {
  EncodedTile result;
  SortedPoints points(tile, progress);
  const auto count = static_cast<std::uint32_t>(tile.points.size());
  const auto all = [count] {
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0U);
    return indices;
  };
  using Encoding = TreeCoder<entropy::SymbolWriter, SortedPoints>;
  std::unique_ptr<Encoding> tree;
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    if (layer == 0) {
      Features coded = features;
      codeFeatures(coder, isOfEffort(features, tile) ? effortOf(tile) : kOwnFeatures, coded);
      // Too large for the stack of a thread.
      tree =
          std::make_unique<Encoding>(features, tile.extent, gridBits(tile.extent), count, points);
      codePhases(coder, features, structure, tree->predictors().phases);
      tree->startSet(count);
      if (!structure.isSpecial()) points.select(all());
    }
    if (layer + 1 < tile.layers) {
      // Cells would not go with mirrors and images, which are worth more than the coarse layers.
      const std::uint64_t cells =
          structure.isSpecial() ? 0 : cellsOfLayer(tile.points.size(), layer, tile.layers);
      tree->coarseLayer(coder, cells);
      result.coarse.push_back(summaryOf(*tree));
    } else if (tree->isUndivided()) {
      SetCoder<entropy::SymbolWriter, SortedPoints>(features, tile.extent, *tree, points)
          .code(coder, structure, count, all());
    } else {
      tree->finalLayer(coder);
    }
    result.layers.push_back(coder.finish());
  }
  result.order = points.takeOrder();
  result.version = 0;
  return result;
}

inline std::size_t totalBytes(const EncodedTile& coded) {
  std::size_t bytes = 0;
  for (const Bytes& layer : coded.layers) bytes += layer.size();
  return bytes;
}

/// Some points that lie together, out of many.
inline std::vector<GridPoint> sampleOf(const TileInput& tile, std::size_t count) {
  const std::vector<GridPoint> all = SortedPoints(tile, {}).all();
  const std::vector<std::uint32_t> sequence = mortonOrder(all, tile.extent);
  std::vector<GridPoint> sample;
  sample.reserve(count);
  const std::size_t first = (all.size() - count) / 2;
  for (std::size_t i = first; i < first + count; ++i) sample.push_back(all[sequence[i]]);
  return sample;
}

/// The features with larger cells, if a sample takes fewer bits with those: what scans of leaves
/// and grass do, and meshes do not.
inline Features withBestCells(const Features& features, const TileInput& tile) {
  constexpr std::size_t kLeastSample = 2048;
  constexpr std::size_t kMostSample = 8192;
  constexpr std::size_t kSampled = 32;  // one point in so many
  Features larger = features;
  larger.cellPoints = Features::kLargeCellPoints;
  TileInput sample;
  sample.wishes = tile.wishes;  // so that what other cells cost in front is part of it
  const std::size_t count = tile.points.size();
  const std::vector<GridPoint> points =
      sampleOf(tile, std::min(std::clamp(count / kSampled, kLeastSample, kMostSample), count));
  sample.points = points;
  sample.lower = points[0];
  GridPoint upper = points[0];
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      sample.lower[k] = std::min(sample.lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) sample.extent[k] = upper[k] - sample.lower[k];
  const std::size_t usual = totalBytes(encodeWith(features, {}, sample, {}));
  const std::size_t other = totalBytes(encodeWith(larger, {}, sample, {}));
  return other < usual ? larger : features;
}

inline EncodedTile encode(const TileInput& tile, const PointProgress& progress) {
  if (tile.points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Unsupported,
                "method predictive codes at most 4,294,967,295 points in one tile, and this set "
                "has " +
                    std::to_string(tile.points.size()));
  }
  const bool isGiven = tile.wishes.features != nullptr;
  Features features = isGiven ? *tile.wishes.features : featuresOf(effortOf(tile));
  constexpr unsigned kTryingEffort = 8;
  constexpr std::size_t kWorthTrying = 20000;  // points; of fewer the sample is too large a part
  if (!isGiven && effortOf(tile) >= kTryingEffort && tile.points.size() >= kWorthTrying) {
    features = withBestCells(features, tile);
  }
  TileStructure structure =
      findStructure(SortedPoints(tile, progress).all(), tile.extent, features);
  EncodedTile best = encodeWith(features, structure, tile, progress);
  // Among few points many pairs look like mirrored ones by chance, and regular patterns mirror
  // themselves although they are told in fewer bits as patterns.
  constexpr std::size_t kFewPoints = 50000;
  if (structure.plane && tile.points.size() <= kFewPoints) {
    structure.plane.reset();
    EncodedTile other = encodeWith(features, structure, tile, progress);
    if (totalBytes(other) < totalBytes(best)) best = std::move(other);
  }
  return best;
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
      codePhases(coder, features, {}, tree->predictors().phases);
      tree->startSet(count);
    }
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) points.numberCells(*tree);
    } else if (tree->isUndivided()) {
      points.forgetCells();
      SetCoder<entropy::SymbolReader, CollectedPoints>(tree->features(), tile.extent, *tree, points)
          .code(coder, {}, static_cast<std::uint32_t>(tile.points), {});
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
