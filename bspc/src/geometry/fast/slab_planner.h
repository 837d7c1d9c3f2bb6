#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/fast/cell.h"
#include "geometry/fast/set_points.h"

namespace bspc::geometry::fast {

struct PlanOptions {
  std::uint32_t largestSlab = 6000;
  std::uint32_t smallestSlab = 250;  ///< cells of so many points or fewer are not split
  bool merge = true;                 ///< merge small slabs upwards where their surfaces continue
  bool compareCosts = false;         ///< also where estimated costs say so
};

/// A node of the partition of a tile into slabs.
struct PlanNode {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  Cell cell;
  std::uint32_t first = 0;                  ///< of the planner's points
  std::uint32_t last = 0;                   ///< one behind
  std::uint32_t child[2] = {kNone, kNone};  ///< lower, upper; kNone if empty
  bool has(unsigned half) const { return child[half] != kNone; }
  bool slab = false;
  unsigned heightAxis = 2;
  std::array<std::uint64_t, 3> shadow{};  ///< by height axis: 8 × 8 footprint that holds points
  float cost = -1;                        ///< estimated bits; negative before it is known
};

/// Partitions the points of a tile into cells whose points lie about on a surface over one of the
/// coordinate planes. A decision of the encoder alone: the tree is transmitted.
class SlabPlanner {
 public:
  using CostEstimate =
      std::function<float(const Cell&, const TilePoint*, std::uint32_t, unsigned heightAxis)>;

  SlabPlanner(StepScale scale, PlanOptions options, CostEstimate estimate)
      : scale_(scale), options_(options), estimate_(std::move(estimate)) {}

  void plan(const SetPoints& points, const Cell& root);

  const std::vector<PlanNode>& nodes() const { return nodes_; }  ///< the root is the first
  /// The points in an order in which every node's are consecutive.
  const std::vector<TilePoint>& points() const { return points_; }

 private:
  static constexpr unsigned kMaxSortedDepth = 14;

  void sortByPath(const SetPoints& points, const Cell& root);
  std::uint32_t split(const Cell& upper, unsigned axis, std::uint32_t path, unsigned depth,
                      std::uint32_t first, std::uint32_t last);
  std::uint32_t build(const Cell& cell, std::uint32_t path, unsigned depth, std::uint32_t first,
                      std::uint32_t last, bool inLarge);
  unsigned heightAxis(const PlanNode& node) const;
  void castShadow(PlanNode& node) const;
  void mergeByShape(PlanNode& node, unsigned axis);
  void mergeByCost(PlanNode& node);
  double shadowArea(const PlanNode& node, unsigned heightAxis) const;
  float cost(PlanNode& node);

  StepScale scale_;
  PlanOptions options_;
  CostEstimate estimate_;
  std::vector<PlanNode> nodes_;
  std::vector<TilePoint> points_;
  std::vector<TilePoint> spare_;
  unsigned sortedDepth_ = 0;
  std::vector<std::uint32_t> starts_;  ///< by path of sortedDepth_ bits
};

}  // namespace bspc::geometry::fast
