#include "geometry/kd/kd_method.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "bspc/error.h"
#include "geometry/kd/kd_order.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/kd/kd_tree_coder.h"
#include "geometry/output_budget.h"

namespace bspc::geometry {

namespace {

/// Points between two calls of the progress callback.
constexpr std::uint64_t kProgressStep = 1U << 16;

/// The encoder's points, in the order of the leaves.
class SortedPoints {
 public:
  SortedPoints(const TileInput& tile, const KdOrder& order, const PointProgress& progress)
      : tile_(tile), order_(order), progress_(progress) {}

  std::uint64_t countLower(const KdCell& cell, unsigned depth) const {
    return order_.countLower(cell.first, cell.count, depth);
  }
  GridPoint at(std::uint64_t j) const {
    GridPoint point = tile_.points[order_.order()[j]];
    for (unsigned k = 0; k < 3; ++k) point[k] -= tile_.lower[k];
    return point;
  }
  void emit(const GridPoint& /*point*/, std::uint64_t count, const KdCell& cell) {
    const std::uint64_t done = cell.first + count;
    if (done < next_) return;
    next_ = done + kProgressStep;
    if (progress_) progress_(done);
  }
  static void cellsInMemory(std::uint64_t /*cells*/) {}

 private:
  const TileInput& tile_;
  const KdOrder& order_;
  const PointProgress& progress_;
  std::uint64_t next_ = kProgressStep;
};

/// The decoder's points, as they come.
class CollectedPoints {
 public:
  CollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : tile_(tile),
        progress_(progress),
        out_(out),
        budget_(tile),
        ownCells_(tile.cellLevel && *tile.cellLevel + 1 == tile.layers) {}

  static std::uint64_t countLower(const KdCell& /*cell*/, unsigned /*depth*/) { return 0; }
  static GridPoint at(std::uint64_t /*j*/) { return {}; }

  void emit(const GridPoint& point, std::uint64_t count, const KdCell& cell) {
    const std::uint64_t id = ownCells_ ? places_++ : cell.id;
    for (std::uint64_t left = count; left > 0; --left) append(point, 1, id);
  }
  void emitRepresentative(const GridPoint& point, const KdCell& cell) {
    append(point, cell.count, cell.id);
  }
  /// A level of the tree at most doubles the cells, so this is called often enough.
  void cellsInMemory(std::uint64_t cells) const { budget_.checkBytes(cells * sizeof(KdCell)); }

 private:
  void append(const GridPoint& point, std::uint64_t count, std::uint64_t id) {
    budget_.beforeAppend(out_);
    out_.points.push_back(point);
    if (tile_.wantCounts) out_.counts.push_back(count);
    if (tile_.cellLevel) out_.cellIds.push_back(id);
    if (progress_ && out_.points.size() % kProgressStep == 0) progress_(out_.points.size());
  }

  const TileToDecode& tile_;
  const PointProgress& progress_;
  DecodedTile& out_;
  OutputBudget budget_;
  bool ownCells_;  ///< ids are asked of the last layer, whose cells are single grid positions
  std::uint64_t places_ = 0;
};

/// Cells that the layer is to have: a quarter of the next finer one's, the last being the points.
std::uint64_t enoughCells(std::uint64_t points, unsigned layer, unsigned layers) {
  const unsigned shift = 2 * (layers - 1 - layer);
  return shift < 64 ? std::max<std::uint64_t>(points >> shift, 1) : 1;
}

using Decoding = KdTreeCoder<entropy::SymbolReader, CollectedPoints>;

void numberCells(std::vector<KdCell>& cells) {
  std::uint64_t id = 0;
  for (KdCell& cell : cells) cell.id = id++;
}

/// A coarse level is shown by the middle of the part of each cell that lies in the tile's box.
void emitRepresentatives(Decoding& tree, CollectedPoints& points) {
  for (const KdCell& cell : tree.frontier()) {
    GridPoint middle = cell.lower;
    for (unsigned k = 0; k < 3; ++k) middle[k] += tree.lastIndex(cell, tree.depth(), k) / 2;
    points.emitRepresentative(middle, cell);
  }
}

}  // namespace

EncodedTile KdMethod::encode(const TileInput& tile, const PointProgress& progress) const {
  if (tile.points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Unsupported,
                "method kd codes at most 4,294,967,295 points in one tile, "
                "and this set has " +
                    std::to_string(tile.points.size()));
  }
  const KdSchedule schedule(tile.extent);
  KdOrder order(tile, schedule);
  SortedPoints points(tile, order, progress);
  // The models are too large for the stack of a thread.
  using Encoding = KdTreeCoder<entropy::SymbolWriter, SortedPoints>;
  const auto tree = std::make_unique<Encoding>(schedule, points, tile.points.size());

  EncodedTile result;
  for (unsigned layer = 0; layer + 1 < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    tree->coarseLayer(coder, enoughCells(tile.points.size(), layer, tile.layers));
    result.layers.push_back(coder.finish());
    result.coarse.push_back({tree->frontier().size(), schedule.spread(tree->depth())});
  }
  entropy::SymbolWriter coder;
  tree->finalLayer(coder);
  result.layers.push_back(coder.finish());
  result.order = order.takeOrder();
  return result;
}

DecodedTile KdMethod::decode(const TileToDecode& tile, const PointProgress& progress) const {
  if (tile.points > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Corrupt, "a tile of method kd claims " + std::to_string(tile.points) +
                                        " points, more than the method allows");
  }
  const KdSchedule schedule(tile.extent);
  if (schedule.depth() > tile.maxDepth) {
    throw Error(ErrorCode::LimitExceeded,
                "a tile has cells of depth " + std::to_string(schedule.depth()) +
                    ", more than the limit of " + std::to_string(tile.maxDepth));
  }
  DecodedTile result;
  CollectedPoints points(tile, progress, result);
  const auto tree = std::make_unique<Decoding>(schedule, points, tile.points);

  for (unsigned layer = 0; layer < tile.payloads.size(); ++layer) {
    entropy::SymbolReader coder(tile.payloads[layer]);
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) numberCells(tree->frontier());
    } else {
      tree->finalLayer(coder);
    }
    coder.finish();
  }
  if (tile.payloads.size() < tile.layers) emitRepresentatives(*tree, points);
  return result;
}

}  // namespace bspc::geometry
