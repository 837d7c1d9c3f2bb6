#include "geometry/fast/slab_planner.h"

#include <algorithm>
#include <cmath>

namespace bspc::geometry::fast {

namespace {

constexpr float kNodeBits = 6;  ///< about what a split costs in the stream

unsigned popcount(std::uint64_t v) { return static_cast<unsigned>(__builtin_popcountll(v)); }

/// Halves the columns of an 8 × 8 mask into its lower four.
std::uint64_t halveColumns(std::uint64_t m) {
  std::uint64_t x = (m | (m >> 1)) & 0x5555555555555555ULL;
  x = (x | (x >> 1)) & 0x3333333333333333ULL;
  return (x | (x >> 2)) & 0x0F0F0F0F0F0F0F0FULL;
}

/// Halves the rows of an 8 × 8 mask into its lower four.
std::uint64_t halveRows(std::uint64_t m) {
  std::uint64_t half = 0;
  for (unsigned row = 0; row < 4; ++row) {
    half |= (((m >> (16 * row)) | (m >> (16 * row + 8))) & 0xFF) << (8 * row);
  }
  return half;
}

}  // namespace

void SlabPlanner::plan(const SetPoints& points, const Cell& root) {
  nodes_.clear();
  sortByPath(points, root);
  build(root, 0, 0, 0, static_cast<std::uint32_t>(points.size()), true);
}

/// The axis that is split depends on the depth alone, so a few tables turn coordinates into paths.
void SlabPlanner::sortByPath(const SetPoints& points, const Cell& root) {
  const unsigned allLevels = root.levels[0] + root.levels[1] + root.levels[2];
  const unsigned wished = entropy::bitLength(points.size() / options_.smallestSlab) + 5;
  sortedDepth_ = std::min({allLevels, wished, kMaxSortedDepth});
  std::array<std::vector<std::uint16_t>, 3> pathBits;
  for (auto& bits : pathBits) bits.assign(1, 0);
  Cell cell = root;
  for (unsigned depth = 0; depth < sortedDepth_; ++depth) {
    const unsigned axis = cell.splitAxis(scale_);
    cell = cell.lowerHalf(axis);
    std::vector<std::uint16_t> finer;
    for (const std::uint16_t path : pathBits[axis]) {
      finer.push_back(path);
      finer.push_back(static_cast<std::uint16_t>(path | (1U << (sortedDepth_ - 1 - depth))));
    }
    pathBits[axis].swap(finer);
  }
  // Counted one place further on, so that the places filled last are the starts.
  starts_.assign((std::size_t{1} << sortedDepth_) + 2, 0);
  std::vector<std::uint16_t> paths(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const GridPoint at = points[i].at;
    unsigned path = 0;
    for (unsigned k = 0; k < 3; ++k) {
      path |= pathBits[k][std::uint64_t{at[k]} >> cell.levels[k]];
    }
    paths[i] = static_cast<std::uint16_t>(path);
    ++starts_[path + 2];
  }
  for (std::size_t p = 1; p < starts_.size(); ++p) starts_[p] += starts_[p - 1];
  points_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points_[starts_[paths[i] + 1U]++] = points[i];
}

/// Where the points of the upper half begin.
std::uint32_t SlabPlanner::split(const Cell& upper, unsigned axis, std::uint32_t path,
                                 unsigned depth, std::uint32_t first, std::uint32_t last) {
  if (depth < sortedDepth_) return starts_[(2 * path + 1) << (sortedDepth_ - depth - 1)];
  if (spare_.size() < last - first) spare_.resize(last - first);
  std::uint32_t low = first;
  std::uint32_t high = 0;
  for (std::uint32_t i = first; i < last; ++i) {
    const TilePoint p = points_[i];
    if (p.at[axis] >= upper.lower[axis]) {
      spare_[high++] = p;
    } else {
      points_[low++] = p;
    }
  }
  std::copy(spare_.begin(), spare_.begin() + high, points_.begin() + low);
  return low;
}

/// `inLarge`: no node above was small enough for a slab.
std::uint32_t SlabPlanner::build(const Cell& cell, std::uint32_t path, unsigned depth,
                                 std::uint32_t first, std::uint32_t last, bool inLarge) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  PlanNode node;
  node.cell = cell;
  node.first = first;
  node.last = last;
  const std::uint32_t count = last - first;
  const bool fits = count <= options_.largestSlab;
  nodes_.push_back(node);
  if (count <= options_.smallestSlab || cell.isUnit()) {
    node.slab = true;
    node.heightAxis = heightAxis(node);
    if (options_.merge) castShadow(node);
    nodes_[id] = node;
    return id;
  }
  const unsigned axis = cell.splitAxis(scale_);
  const Cell upper = cell.upperHalf(axis);
  const std::uint32_t middle = split(upper, axis, path, depth, first, last);
  if (middle > first) {
    node.child[0] =
        build(cell.lowerHalf(axis), 2 * path, depth + 1, first, middle, inLarge && !fits);
  }
  if (last > middle) {
    node.child[1] = build(upper, 2 * path + 1, depth + 1, middle, last, inLarge && !fits);
  }
  if (options_.merge && fits) mergeByShape(node, axis);
  if (options_.compareCosts && fits && inLarge) mergeByCost(node);
  nodes_[id] = node;
  return id;
}

/// The axis over whose plane the points spread most: the largest 2 × 2 minor of their covariance.
unsigned SlabPlanner::heightAxis(const PlanNode& node) const {
  const std::uint32_t count = node.last - node.first;
  if (count < 4) return 2;
  const std::uint32_t step = count >= 64 ? count / 32 : 1;
  float s[3] = {};
  float m[6] = {};
  float n = 0;
  for (std::uint32_t i = node.first; i < node.last; i += step) {
    float p[3];
    for (unsigned k = 0; k < 3; ++k) {
      p[k] = static_cast<float>(points_[i].at[k] - node.cell.lower[k]);
      s[k] += p[k];
    }
    m[0] += p[0] * p[0];
    m[1] += p[1] * p[1];
    m[2] += p[2] * p[2];
    m[3] += p[1] * p[2];
    m[4] += p[0] * p[2];
    m[5] += p[0] * p[1];
    ++n;
  }
  double variance[3];
  double covariance[3];  // of the two other axes
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned a = (k + 1) % 3;
    const unsigned b = (k + 2) % 3;
    const double mean = s[k] / n;
    variance[k] = (m[k] / n - mean * mean) * std::ldexp(1.0, 2 * scale_[k]);
    covariance[k] =
        (m[3 + k] / n - (s[a] / n) * double{s[b] / n}) * std::ldexp(1.0, scale_[a] + scale_[b]);
  }
  double largest = 0;
  unsigned axis = 2;
  for (unsigned k = 3; k-- > 0;) {
    const double minor =
        variance[(k + 1) % 3] * variance[(k + 2) % 3] - covariance[k] * covariance[k];
    if (minor > largest) {
      largest = minor;
      axis = k;
    }
  }
  return axis;
}

void SlabPlanner::castShadow(PlanNode& node) const {
  const std::uint32_t count = node.last - node.first;
  const std::uint32_t step = count >= 96 ? count / 48 : 1;
  unsigned shift[3];
  for (unsigned k = 0; k < 3; ++k)
    shift[k] = static_cast<unsigned>(std::max(0, node.cell.levels[k] - 3));
  for (std::uint32_t i = node.first; i < node.last; i += step) {
    unsigned p[3];
    for (unsigned k = 0; k < 3; ++k) p[k] = (points_[i].at[k] - node.cell.lower[k]) >> shift[k];
    for (unsigned k = 0; k < 3; ++k) {
      node.shadow[k] |= std::uint64_t{1} << (8 * p[(k + 2) % 3] + p[(k + 1) % 3]);
    }
  }
}

double SlabPlanner::shadowArea(const PlanNode& node, unsigned heightAxis) const {
  int log = 0;
  for (unsigned k = 0; k < 3; ++k) {
    if (k != heightAxis) log += node.cell.levels[k] + scale_[k];
  }
  return std::ldexp(popcount(node.shadow[heightAxis]), log);
}

/// Merges two slabs if seen along the common height axis they cover as much as each along its own,
/// and do not lie above one another.
void SlabPlanner::mergeByShape(PlanNode& node, unsigned axis) {
  static const PlanNode kEmpty{};
  const PlanNode& low = node.has(0) ? nodes_[node.child[0]] : kEmpty;
  const PlanNode& high = node.has(1) ? nodes_[node.child[1]] : kEmpty;
  if ((node.has(0) && !low.slab) || (node.has(1) && !high.slab)) return;
  const unsigned levels = node.cell.levels[axis];
  bool stacked[3] = {};
  for (unsigned h = 0; h < 3; ++h) {
    const std::uint64_t a = low.shadow[h];
    const std::uint64_t b = high.shadow[h];
    if (axis == (h + 1) % 3) {
      node.shadow[h] =
          levels <= 3 ? a | (b << (1U << (levels - 1))) : halveColumns(a) | (halveColumns(b) << 4);
    } else if (axis == (h + 2) % 3) {
      node.shadow[h] =
          levels <= 3 ? a | (b << (8U << (levels - 1))) : halveRows(a) | (halveRows(b) << 32);
    } else {
      node.shadow[h] = a | b;
      stacked[h] = popcount(a & b) * 10 > std::min(popcount(a), popcount(b)) * 6;
    }
  }
  unsigned height = !node.has(0) ? high.heightAxis : low.heightAxis;
  if (node.has(0) && node.has(1)) {
    height = heightAxis(node);
    const double together = shadowArea(low, height) + shadowArea(high, height);
    const double apart = shadowArea(low, low.heightAxis) + shadowArea(high, high.heightAxis);
    if (together < apart) return;
  }
  if (stacked[height]) return;
  node.slab = true;
  node.heightAxis = height;
}

float SlabPlanner::cost(PlanNode& node) {
  if (node.cost >= 0) return node.cost;
  if (node.slab) {
    node.cost =
        estimate_(node.cell, points_.data() + node.first, node.last - node.first, node.heightAxis);
  } else {
    node.cost = kNodeBits;
    for (const std::uint32_t child : node.child) {
      if (child != PlanNode::kNone) node.cost += cost(nodes_[child]);
    }
  }
  return node.cost;
}

void SlabPlanner::mergeByCost(PlanNode& node) {
  if (node.slab) return;
  const float apart = cost(node);
  const unsigned height = heightAxis(node);
  const float together =
      estimate_(node.cell, points_.data() + node.first, node.last - node.first, height);
  if (together >= apart) return;
  node.slab = true;
  node.heightAxis = height;
  node.cost = together;
}

}  // namespace bspc::geometry::fast
