#include "geometry/partition/partition_method.h"

#include <memory>
#include <string>

#include "bspc/error.h"
#include "geometry/cell_output.h"
#include "geometry/kd/kd_order.h"
#include "geometry/partition/occupancy_symbols.h"
#include "geometry/partition/partition_tree_coder.h"
#include "geometry/tile_bounds.h"

namespace bspc::geometry {

namespace {

/// The encoder's points, in the order of the leaves.
class SortedPoints {
 public:
  SortedPoints(const TileInput& tile, const KdOrder& order, const PointProgress& progress)
      : tile_(tile), order_(order), progress_(progress) {}

  std::uint64_t countLower(std::uint64_t first, std::uint64_t count, unsigned depth) const {
    return order_.countLower(first, count, depth);
  }
  GridPoint at(std::uint64_t j) const {
    GridPoint point = tile_.points[order_.order()[static_cast<std::size_t>(j)]];
    for (std::size_t k = 0; k < 3; ++k) point[k] -= tile_.lower[k];
    return point;
  }
  void emit(const GridPoint& /*point*/, std::uint64_t count, const PartitionCell& cell) {
    constexpr std::uint64_t kProgressStep = 1U << 16;
    const std::uint64_t done = cell.first + count;
    if (done < next_) return;
    next_ = done + kProgressStep;
    if (progress_) progress_(done);
  }
  static void cellsInMemory(std::uint64_t /*bytes*/) {}
  static void working() {}

 private:
  const TileInput& tile_;
  const KdOrder& order_;
  const PointProgress& progress_;
  std::uint64_t next_ = 0;
};

/// The decoder's points, as they come.
class CollectedPoints {
 public:
  CollectedPoints(const TileToDecode& tile, const PointProgress& progress, DecodedTile& out)
      : output_(tile, progress, out) {}

  static std::uint64_t countLower(std::uint64_t /*first*/, std::uint64_t /*count*/,
                                  unsigned /*depth*/) {
    return 0;
  }
  static GridPoint at(std::uint64_t /*j*/) { return {}; }
  void emit(const GridPoint& point, std::uint64_t count, const PartitionCell& cell) {
    output_.leaf(point, count, cell.id);
  }
  void cellsInMemory(std::uint64_t bytes) { output_.hold(bytes); }
  void working() { output_.working(); }
  CellOutput& output() { return output_; }

 private:
  CellOutput output_;
};

}  // namespace

template <class Symbols>
EncodedTile PartitionMethod<Symbols>::encode(const TileInput& tile,
                                             const PointProgress& progress) const {
  checkTileBounds(methodName(id_), tile, kMaxBits);
  const KdSchedule schedule(tile.extent);
  KdOrder order(tile, schedule);
  SortedPoints points(tile, order, progress);
  using Encoding = PartitionTreeCoder<entropy::SymbolWriter, SortedPoints, Symbols>;
  const auto tree = std::make_unique<Encoding>(schedule, points, tile.points.size());
  EncodedTile result;
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, cellsOfLayer(tile.points.size(), layer, tile.layers));
      result.coarse.push_back({tree->frontier().size(), schedule.spread(tree->depth())});
    } else {
      tree->finalLayer(coder);
    }
    result.layers.push_back(coder.finish());
  }
  result.order = order.takeOrder();
  return result;
}

template <class Symbols>
DecodedTile PartitionMethod<Symbols>::decode(const TileToDecode& tile,
                                             const PointProgress& progress) const {
  checkTileBounds(methodName(id_), tile, kMaxBits);
  const KdSchedule schedule(tile.extent);
  if (schedule.depth() > tile.maxDepth) {
    throw Error(ErrorCode::LimitExceeded,
                "a tile has cells of depth " + std::to_string(schedule.depth()) +
                    ", more than the limit of " + std::to_string(tile.maxDepth));
  }
  DecodedTile result;
  CollectedPoints points(tile, progress, result);
  using Decoding = PartitionTreeCoder<entropy::SymbolReader, CollectedPoints, Symbols>;
  const auto tree = std::make_unique<Decoding>(schedule, points, tile.points);
  for (unsigned layer = 0; layer < tile.payloads.size(); ++layer) {
    entropy::SymbolReader coder(tile.payloads[layer]);
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) {
        std::uint64_t id = 0;
        for (PartitionCell& cell : tree->frontier()) cell.id = id++;
      }
    } else {
      tree->finalLayer(coder);
    }
    coder.finish();
  }
  if (tile.payloads.size() == tile.layers) return result;
  for (const PartitionCell& cell : tree->frontier()) {
    GridPoint middle = cell.lower;
    for (unsigned k = 0; k < 3; ++k) middle[k] += tree->lastIndex(cell, tree->depth(), k) / 2;
    points.output().representative(middle, cell.count, cell.id);
  }
  return result;
}

const GeometryMethod& octreeMethod() {
  static const PartitionMethod<OctreeSymbols> method(Method::Octree);
  return method;
}

const GeometryMethod& genCodeMethod() {
  static const PartitionMethod<GenCodeSymbols> method(Method::GenCode);
  return method;
}

}  // namespace bspc::geometry
