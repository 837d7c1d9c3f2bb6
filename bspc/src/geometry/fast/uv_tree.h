#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"
#include "geometry/fast/cell.h"

namespace bspc::geometry::fast {

/// Position in a slab's plane.
struct PlanePoint {
  std::uint32_t c[2];
};

/// The (u, v) of a slab's points as a kd-tree in the plane: level by level, every split predicted
/// from the cells beside it; below a depth where most cells have a point alone, raw bits.
///
/// Coder is SymbolWriter or SymbolReader, Raw is BitWriter or BitReader; a writer codes the points
/// that it is given, a reader fills them in. Models live from slab to slab.
template <class Coder, class Raw>
class UvTree {
 public:
  static constexpr std::uint64_t kMaxPoints = 65535;

  /// `extraLevels`: how many levels deeper than one point a cell the contexts go.
  UvTree(Coder& coder, Raw& raw, unsigned extraLevels)
      : coder_(coder), raw_(raw), extraLevels_(extraLevels) {}

  /// Codes 1 … kMaxPoints points of a plane that is not a single position. A writer's points come
  /// back in the order of the tree.
  void code(const SlabFrame& frame, const StepScale& scale, std::vector<PlanePoint>& points) {
    schedule(frame, scale, points.size());
    if (Coder::kWriting) countPoints(points);
    refine(static_cast<std::uint32_t>(points.size()));
    finish(points);
  }

  /// Bytes that code() needs for so many points, at most.
  std::uint64_t memory(std::uint64_t points) const {
    const unsigned depth = std::min(entropy::bitLength(points) + extraLevels_, kMaxDepth);
    // With its border, a level has up to three times its cells, and all levels twice the last's.
    return 5 * sizeof(Node) * points + (std::uint64_t{12} << depth) + 1024;
  }

 private:
  static constexpr unsigned kMaxDepth = 20;
  static constexpr unsigned kContextLevels = 14;

  struct Node {
    std::uint32_t at[2];
    std::uint32_t points;
  };
  /// Counts of a level's cells, with a border of empty ones.
  struct Level {
    unsigned bits[2] = {};
    std::size_t first = 0;
    std::size_t width() const { return (std::size_t{1} << bits[0]) + 2; }
    std::size_t height() const { return (std::size_t{1} << bits[1]) + 2; }
    std::size_t index(std::uint32_t x, std::uint32_t y) const {
      return first + (y + 1) * width() + x + 1;
    }
  };
  struct Models {
    std::array<std::array<entropy::AdaptiveBit, 144>, kContextLevels> single;
    std::array<std::array<entropy::AdaptiveBit, 36>, kContextLevels> pairSplits;
    std::array<std::array<entropy::AdaptiveBit, 36>, kContextLevels> pairSide;
    std::array<std::array<std::array<std::array<entropy::AdaptiveBit, 16>, 3>, 16>, kContextLevels>
        few;
    std::array<std::array<entropy::AdaptiveBit, 16>, 4> many;
  };

  void schedule(const SlabFrame& frame, const StepScale& scale, std::size_t points) {
    int left[2] = {static_cast<int>(frame.levels[0]), static_cast<int>(frame.levels[1])};
    const unsigned wanted = entropy::bitLength(points) + extraLevels_;
    depth_ = std::min({frame.levels[0] + frame.levels[1], wanted, kMaxDepth});
    std::size_t cells = 0;
    for (unsigned d = 0; d <= depth_; ++d) {
      Level& level = levels_[d];
      if (d == 0) {
        level.bits[0] = level.bits[1] = 0;
      } else {
        const bool both = left[0] > 0 && left[1] > 0;
        const int longer = left[1] + scale[frame.axis[1]] - left[0] - scale[frame.axis[0]];
        const unsigned axis = both ? (longer > 0 ? 1 : 0) : (left[0] > 0 ? 0 : 1);
        axis_[d - 1] = axis;
        --left[axis];
        level = levels_[d - 1];
        ++level.bits[axis];
      }
      level.first = cells;
      cells += level.width() * level.height();
    }
    below_[0] = static_cast<unsigned>(left[0]);
    below_[1] = static_cast<unsigned>(left[1]);
    counts_.assign(cells, 0);
    firstContextLevel_ = static_cast<int>(entropy::bitLength(points)) - 1 - 6;
  }

  unsigned contextLevel(unsigned depth) const {
    return static_cast<unsigned>(std::clamp(static_cast<int>(depth) - firstContextLevel_, 0,
                                            static_cast<int>(kContextLevels) - 1));
  }

  void countPoints(const std::vector<PlanePoint>& points) {
    for (const PlanePoint& p : points) {
      ++counts_[levels_[depth_].index(p.c[0] >> below_[0], p.c[1] >> below_[1])];
    }
    for (unsigned d = depth_; d-- > 0;) {
      const Level& coarse = levels_[d];
      const Level& fine = levels_[d + 1];
      const unsigned sx = axis_[d] == 0 ? 1 : 0;
      const unsigned sy = 1 - sx;
      for (std::uint32_t y = 0; y >> coarse.bits[1] == 0; ++y) {
        for (std::uint32_t x = 0; x >> coarse.bits[0] == 0; ++x) {
          counts_[coarse.index(x, y)] =
              static_cast<std::uint16_t>(counts_[fine.index(x << sx, y << sy)] +
                                         counts_[fine.index((x << sx) + sx, (y << sy) + sy)]);
        }
      }
    }
  }

  void refine(std::uint32_t points) {
    frontier_.assign(1, Node{{0, 0}, points});
    counts_[levels_[0].index(0, 0)] = static_cast<std::uint16_t>(points);
    for (unsigned d = 0; d < depth_; ++d) {
      next_.resize(2 * frontier_.size());
      Node* out = next_.data();
      for (const Node& node : frontier_) out = split(node, d, out);
      next_.resize(static_cast<std::size_t>(out - next_.data()));
      frontier_.swap(next_);
    }
  }

  Node* split(const Node& node, unsigned d, Node* out) {
    const unsigned axis = axis_[d];
    const Level& coarse = levels_[d];
    const Level& fine = levels_[d + 1];
    const auto at = [](unsigned v, unsigned doubled) { return v << doubled; };
    const std::uint32_t x = at(node.at[0], 1 - axis);
    const std::uint32_t y = at(node.at[1], axis);
    const std::size_t along = axis == 0 ? 1 : coarse.width();
    const std::size_t across = axis == 0 ? coarse.width() : 1;
    const std::size_t fineAlong = axis == 0 ? 1 : fine.width();
    const std::size_t fineAcross = axis == 0 ? fine.width() : 1;
    const std::uint16_t* here = &counts_[coarse.index(node.at[0], node.at[1])];
    std::uint16_t* child = &counts_[fine.index(x, y)];
    const std::uint32_t near = *(child - fineAlong);
    const std::uint32_t far = *(here - along) - near;
    const std::uint32_t ahead = here[along];
    const std::uint32_t opposite = here[across];
    const std::uint32_t side0 = *(child - fineAcross);
    const std::uint32_t side1 = *(child - fineAcross + fineAlong);
    const auto upTo2 = [](std::uint32_t n) { return std::min(n, 2U); };
    const auto some = [](std::uint32_t n) { return n > 0 ? 1U : 0U; };
    const unsigned ends = upTo2(near) * 3 + upTo2(ahead);
    const unsigned level = contextLevel(d);
    std::uint32_t lower = 0;
    if (node.points == 1) {
      const unsigned context =
          (((ends * 2 + some(far)) * 2 + some(side0)) * 2 + some(side1)) * 2 + some(opposite);
      lower = coder_.bit(models_.single[level][context], child[0] != 0) ? 1 : 0;
    } else {
      const std::uint32_t towardsLower = 2 * near + side0;
      const std::uint32_t towardsUpper = ahead + side1;
      const unsigned balance = towardsLower > towardsUpper   ? 0
                               : towardsLower < towardsUpper ? 2
                                                             : 1;
      const unsigned context = (ends * 2 + some(side0)) * 2 + some(side1);
      lower = codeCount(level, node.points, child[0], balance, context);
    }
    const std::uint32_t upper = node.points - lower;
    child[0] = static_cast<std::uint16_t>(lower);
    child[fineAlong] = static_cast<std::uint16_t>(upper);
    *out = Node{{x, y}, lower};
    out += lower > 0 ? 1 : 0;
    *out = Node{{x + (1 - axis), y + axis}, upper};
    return out + (upper > 0 ? 1 : 0);
  }

  /// The number of n ≥ 2 points in the lower half.
  std::uint32_t codeCount(unsigned level, std::uint32_t n, std::uint32_t lower, unsigned balance,
                          unsigned context) {
    if (n == 2) {
      if (coder_.bit(models_.pairSplits[level][context], lower == 1)) return 1;
      return coder_.bit(models_.pairSide[level][context], lower == 2) ? 2 : 0;
    }
    if (n < 16) {
      std::uint32_t low = 0;
      std::uint32_t high = n;
      unsigned node = 1;
      while (low < high) {
        const std::uint32_t middle = (low + high + 1) / 2;
        const bool above = coder_.bit(models_.few[level][n][balance][node], lower >= middle);
        (above ? low : high) = above ? middle : middle - 1;
        node = 2 * node + (above ? 1 : 0);
        if (node > 15) node = 8 + (node & 7);
      }
      return low;
    }
    const unsigned size = n < 64 ? 0 : n < 256 ? 1 : n < 1024 ? 2 : 3;
    const std::uint32_t wanted = lower * 16 / (n + 1);
    unsigned node = 1;
    for (unsigned shift = 4; shift-- > 0;) {
      const bool one = coder_.bit(models_.many[size][node], ((wanted >> shift) & 1) != 0);
      node = 2 * node + (one ? 1 : 0);
    }
    const std::uint32_t bucket = node - 16;
    const std::uint32_t first = (bucket * (n + 1) + 15) / 16;
    const std::uint32_t last = ((bucket + 1) * (n + 1) + 15) / 16 - 1;
    return first + coder_.uniform(lower - first, last - first);
  }

  void finish(std::vector<PlanePoint>& points) {
    if (Coder::kWriting) sortByLeaf(points);
    PlanePoint* p = points.data();
    for (const Node& node : frontier_) {
      codeBelow(p, node.points, below_[0], below_[1]);
      for (std::uint32_t i = 0; i < node.points; ++i) {
        for (unsigned k = 0; k < 2; ++k) p[i].c[k] |= node.at[k] << below_[k];
      }
      p += node.points;
    }
  }

  /// Groups a writer's points by the leaves of the tree, and leaves only what is below them.
  void sortByLeaf(std::vector<PlanePoint>& points) {
    starts_.resize(counts_.size() - levels_[depth_].first);
    const auto cell = [this](std::uint32_t x, std::uint32_t y) {
      return levels_[depth_].index(x, y) - levels_[depth_].first;
    };
    std::uint32_t start = 0;
    for (const Node& node : frontier_) {
      starts_[cell(node.at[0], node.at[1])] = start;
      start += node.points;
    }
    sorted_.resize(points.size());
    for (const PlanePoint& p : points) {
      PlanePoint& to = sorted_[starts_[cell(p.c[0] >> below_[0], p.c[1] >> below_[1])]++];
      for (unsigned k = 0; k < 2; ++k) to.c[k] = p.c[k] & ((1U << below_[k]) - 1);
    }
    points.swap(sorted_);
  }

  /// Points of one cell below the tree: single ones raw, several split without neighbours.
  void codeBelow(PlanePoint* p, std::uint32_t n, unsigned bu, unsigned bv) {
    if (!Coder::kWriting && bu + bv == 0) std::fill(p, p + n, PlanePoint{{0, 0}});
    if (bu + bv == 0) return;
    if (n == 1) {
      const std::uint64_t bits = raw_.code((std::uint64_t{p->c[0]} << bv) | p->c[1], bu + bv);
      p->c[0] = static_cast<std::uint32_t>(bits >> bv);
      p->c[1] = static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << bv) - 1));
      return;
    }
    const unsigned axis = bv > bu ? 1 : 0;
    unsigned& bits = axis == 0 ? bu : bv;
    --bits;
    const std::uint32_t bit = 1U << bits;
    std::uint32_t lower = 0;
    if (Coder::kWriting) {
      const auto inLower = [axis, bit](const PlanePoint& q) { return (q.c[axis] & bit) == 0; };
      lower = static_cast<std::uint32_t>(std::partition(p, p + n, inLower) - p);
      for (std::uint32_t i = lower; i < n; ++i) p[i].c[axis] &= ~bit;
    }
    lower = codeCount(kContextLevels - 1, n, lower, 1, 0);
    if (lower > 0) codeBelow(p, lower, bu, bv);
    if (lower < n) codeBelow(p + lower, n - lower, bu, bv);
    for (std::uint32_t i = lower; i < n; ++i) p[i].c[axis] |= bit;
  }

  Coder& coder_;
  Raw& raw_;
  unsigned extraLevels_;
  Models models_;
  unsigned depth_ = 0;
  int firstContextLevel_ = 0;
  std::array<unsigned, kMaxDepth> axis_{};
  std::array<Level, kMaxDepth + 1> levels_{};
  unsigned below_[2] = {};
  std::vector<std::uint16_t> counts_;
  std::vector<Node> frontier_;
  std::vector<Node> next_;
  std::vector<PlanePoint> sorted_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace bspc::geometry::fast
