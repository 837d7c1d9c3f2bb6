#include "geometry/kd/kd_method.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "bspc/error.h"
#include "geometry/cell_output.h"
#include "geometry/kd/kd_order.h"
#include "geometry/kd/kd_schedule.h"
#include "geometry/kd/kd_tree_coder.h"

namespace bspc::geometry {

namespace {

/// Streams of this version start with the rule that a lossy coding stops by.
constexpr unsigned kLossyVersion = 1;

/// Points between two calls of the progress callback.
constexpr std::uint64_t kProgressStep = 1U << 16;

/// The encoder's points, in the order of the leaves.
class SortedPoints {
 public:
  SortedPoints(const TileInput& tile, const KdOrder& order, const PointProgress& progress)
      : tile_(tile),
        order_(order),
        progress_(progress),
        lossy_(StopRule::of(tile.wishes).lossy()) {}

  std::uint64_t countLower(const KdCell& cell, unsigned depth) const {
    return order_.countLower(cell.first, cell.count, depth);
  }
  GridPoint at(std::uint64_t j) const {
    GridPoint point = tile_.points[order_.order()[j]];
    for (unsigned k = 0; k < 3; ++k) point[k] -= tile_.lower[k];
    return point;
  }
  void emit(const GridPoint& point, std::uint64_t count, const KdCell& cell) {
    if (lossy_) decoded_.insert(decoded_.end(), static_cast<std::size_t>(count), point);
    const std::uint64_t done = cell.first + count;
    if (done < next_) return;
    next_ = done + kProgressStep;
    if (progress_) progress_(done);
  }
  void emitUndivided(const GridPoint& middle, const KdCell& cell) {
    decoded_.insert(decoded_.end(), static_cast<std::size_t>(cell.count), middle);
  }
  static void cellsInMemory(std::uint64_t /*bytes*/) {}
  static void working() {}
  std::vector<GridPoint> takeDecoded() { return std::move(decoded_); }

 private:
  const TileInput& tile_;
  const KdOrder& order_;
  const PointProgress& progress_;
  bool lossy_;
  std::vector<GridPoint> decoded_;  ///< of a lossy coding
  std::uint64_t next_ = kProgressStep;
};

/// The decoder's points, as they come.
class CollectedPoints {
 public:
  CollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : output_(tile, progress, out) {}

  static std::uint64_t countLower(const KdCell& /*cell*/, unsigned /*depth*/) { return 0; }
  static GridPoint at(std::uint64_t /*j*/) { return {}; }

  void emit(const GridPoint& point, std::uint64_t count, const KdCell& cell) {
    output_.leaf(point, count, cell.id);
  }
  void emitUndivided(const GridPoint& point, const KdCell& cell) {
    output_.leaf(point, cell.count, cell.id);
  }
  void cellsInMemory(std::uint64_t bytes) { output_.hold(bytes); }
  void working() { output_.working(); }
  CellOutput& output() { return output_; }

 private:
  CellOutput output_;
};

using Decoding = KdTreeCoder<entropy::SymbolReader, CollectedPoints>;

void numberCells(std::vector<KdCell>& cells) {
  std::uint64_t id = 0;
  for (KdCell& cell : cells) cell.id = id++;
}

/// Greatest distance along an axis of a point to the middle of its cell.
std::uint32_t spreadOf(const std::vector<KdCell>& cells, const KdSchedule& schedule) {
  unsigned least = KdSchedule::kMaxDepth;
  for (const KdCell& cell : cells) least = std::min<unsigned>(least, cell.depth);
  return schedule.spread(std::min(least, schedule.depth()));
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
  const StopRule stop = StopRule::of(tile.wishes);
  // The models are too large for the stack of a thread.
  using Encoding = KdTreeCoder<entropy::SymbolWriter, SortedPoints>;
  const auto tree = std::make_unique<Encoding>(schedule, points, tile.points.size(), stop);

  EncodedTile result;
  for (unsigned layer = 0; layer + 1 < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    if (layer == 0 && stop.lossy()) tree->head(coder);
    tree->coarseLayer(coder, cellsOfLayer(tile.points.size(), layer, tile.layers));
    result.layers.push_back(coder.finish());
    result.coarse.push_back({tree->frontier().size(), spreadOf(tree->frontier(), schedule)});
  }
  entropy::SymbolWriter coder;
  if (tile.layers == 1 && stop.lossy()) tree->head(coder);
  tree->finalLayer(coder);
  result.layers.push_back(coder.finish());
  result.decoded = points.takeDecoded();
  result.version = stop.lossy() ? kLossyVersion : 0;
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
    if (layer == 0 && tile.version >= kLossyVersion) tree->head(coder);
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) numberCells(tree->frontier());
    } else {
      tree->finalLayer(coder);
    }
    coder.finish();
  }
  if (tile.payloads.size() == tile.layers) return result;
  // A coarse level is shown by the middles of its cells.
  for (const KdCell& cell : tree->frontier()) {
    points.output().representative(tree->middle(cell), cell.count, cell.id);
  }
  return result;
}

}  // namespace bspc::geometry
