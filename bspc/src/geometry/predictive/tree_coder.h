#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "geometry/predictive/box.h"
#include "geometry/predictive/decision_model.h"
#include "geometry/predictive/node_tree.h"
#include "geometry/predictive/predictors.h"
#include "geometry/predictive/residual_model.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// The traversal, for encoder and decoder alike: an octree breadth first, each cell halved across
/// x, y and z with the number of points in one half coded, until cells have few points; then cell
/// by cell in Morton order depth first, so that the points of one are known when the next begins.
///
/// `Points` answers the encoder's questions and takes the decoder's points:
///   std::uint32_t countUpper(first, count, axis, value)   points from `value` on
///   void emit(const GridPoint&, std::uint32_t count, std::uint32_t node)
///   void added(std::uint32_t parent, std::uint32_t node)  a cell was divided
///   void working(std::uint64_t bytes)                     from time to time; throws to stop
/// On the decoder's side the first returns anything.
template <class Coder, class Points>
class TreeCoder {
 public:
  /// `extent`: greatest coordinates of the tile; `bits`: of the largest of them; `count`: points of
  /// the tile.
  TreeCoder(const Features& features, const GridPoint& extent, unsigned bits, std::uint32_t count,
            Points& points)
      : features_(features),
        extent_(extent),
        bits_(bits),
        points_(points),
        p_(features, bits, count) {}

  const NodeTree& nodes() const { return nodes_; }
  const Features& features() const { return features_; }
  bool isUndivided() const { return level_ == 0; }
  Predictors& predictors() { return p_; }

  /// A set of points of its own: nothing is known of it yet, but what was learned stays.
  void startSet(std::uint32_t count) {
    nodes_.clear();
    known_.clear();
    level_ = 0;
    if (count == 0) return;
    Node root;
    root.count = count;
    root.open = static_cast<std::uint8_t>(bits_);
    nodes_.add(root);
  }

  /// One coarse layer: levels are divided until `enough` cells are undivided (the encoder's wish;
  /// the stream says after each level whether the layer goes on).
  void coarseLayer(Coder& coder, std::uint64_t enough) {
    coder_ = &coder;
    while (levelRemains() && coder.bit(deeper_, undivided() < enough)) divideLevel();
  }

  void finalLayer(Coder& coder) {
    coder_ = &coder;
    while (levelRemains()) divideLevel();
    if (nodes_.size() > 0) walk(0);
  }

  /// Calls `visit` with the index of every undivided cell.
  template <class Visit>
  void forEachUndivided(Visit visit) const {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      if (!nodes_[i].divided()) visit(i);
    }
  }

 private:
  bool levelRemains() const { return level_ < nodes_.size(); }
  std::uint64_t undivided() const { return undivided_; }

  float lowerOf(const Box& box, unsigned k) const {
    return static_cast<float>(static_cast<std::int64_t>(box.lower[k]) - origin_[k]);
  }
  Question questionOf(const Box& box, unsigned axis) const {
    Question q;
    for (unsigned k = 0; k < 3; ++k) {
      q.lower[k] = lowerOf(box, k);
      q.size[k] = static_cast<float>(std::int64_t{1} << box.open[k]);
    }
    q.turnTo(axis, box.open[axis], box.lower[axis]);
    return q;
  }

  /// How many of the box's points lie in its upper half.
  std::uint32_t split(const Box& box, const Question& q, std::uint32_t first, std::uint32_t count) {
    const std::uint64_t middle = box.middle(q.axis);
    const bool isFlat = isFlatFor(q, count);
    if (middle > extent_[q.axis]) {
      p_.skip(q, isFlat);
      return 0;
    }
    const std::uint32_t upper =
        Coder::kWriting
            ? points_.countUpper(first, count, q.axis, static_cast<std::uint32_t>(middle))
            : 0;
    if (isFlat) {
      p_.askFlat(q);
      return model_.codeFlat(*coder_, upper != 0, q, p_) ? 1 : 0;
    }
    p_.ask(q);
    return model_.code(*coder_, upper, count, q, p_);
  }

  bool isFlatFor(const Question& q, std::uint32_t count) const {
    return count == 1 && p_.inCell && p_.flat.isFlat(q);
  }

  void useOrigin(const Node& node) {
    for (unsigned k = 0; k < 3; ++k) origin_[k] = node.lower(k);
  }

  // Breadth first.
  void divideLevel();
  void gatherBreadthFirst(const Node& node);
  void divide(Box box, unsigned axis, std::uint32_t first, std::uint32_t count);
  void addCell(const Node& node) {
    const auto side = static_cast<float>(node.side());
    std::array<float, 3> middle{};
    for (unsigned k = 0; k < 3; ++k) middle[k] = middleOf(node, k);
    p_.near.add(middle[0], middle[1], middle[2], static_cast<float>(node.count),
                p_.inCell ? side : side + 1, Neighbourhood::kCell);
  }
  float middleOf(const Node& node, unsigned k) const {
    return static_cast<float>(node.lower(k) - origin_[k]) + 0.5F * static_cast<float>(node.side());
  }

  /// Along the axis where that is most, in cells. Both are of one size.
  static std::uint32_t distanceBetween(const Node& one, const Node& other) {
    std::uint32_t most = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t a = one.cell[k];
      const std::uint32_t b = other.cell[k];
      most = std::max(most, a > b ? a - b : b - a);
    }
    return most;
  }

  // Depth first.
  /// Farther points are looked for unless so many more are around than make candidates.
  static constexpr unsigned kSparePoints = 8;
  void walk(std::uint32_t index);
  void codeCell(std::uint32_t index);
  void gatherDepthFirst(const Node& node);
  void gatherChildren(const Node& parent, const Node& node, float& count, float& area);
  void gatherFarther(const Node& node);
  void addFinished(const Node& node);
  void addKnown(const Node& node);
  void refine(Box& box, unsigned axis, std::uint32_t first, std::uint32_t count, bool halved);
  void refineOne(Box box, unsigned axis, std::uint32_t first);
  void codeResiduals(Box box, Question q, std::uint32_t first);
  void emit(const Box& box, std::uint32_t count);

  const Features features_;
  const GridPoint extent_;
  const unsigned bits_;
  Points& points_;
  Coder* coder_ = nullptr;
  entropy::AdaptiveBit deeper_;
  NodeTree nodes_;
  KnownPoints known_;
  std::uint32_t level_ = 0;  ///< first node that may still be divided breadth first
  std::uint64_t undivided_ = 1;
  std::array<std::int64_t, 3> origin_{};  ///< lower corner of the cell at hand
  std::uint32_t cell_ = 0;                ///< its index
  std::uint32_t remaining_ = 0;           ///< points of it that are not coded
  bool changed_ = true;                   ///< a point was found since the last startBox()
  Predictors p_;
  DecisionModel model_;
  ResidualModel residualModel_;
};

template <class Coder, class Points>
void TreeCoder<Coder, Points>::divideLevel() {
  const std::uint32_t end = nodes_.size();
  for (std::uint32_t i = level_; i < end; ++i) {
    const Node node = nodes_[i];
    if (node.count <= features_.cellPoints || node.open == 0) continue;
    useOrigin(node);
    p_.inCell = false;
    gatherBreadthFirst(node);
    const auto side = static_cast<float>(node.side());
    p_.startBreadthFirst({0.5F * side, 0.5F * side, 0.5F * side}, side);
    Box box;
    for (unsigned k = 0; k < 3; ++k) {
      box.lower[k] = static_cast<std::uint32_t>(node.lower(k));
      box.open[k] = node.open;
    }
    cell_ = i;
    const std::uint32_t firstChild = nodes_.size();
    divide(box, 0, node.first, node.count);
    nodes_[i].firstChild = firstChild;
    nodes_[i].children = static_cast<std::uint8_t>(nodes_.size() - firstChild);
    undivided_ += nodes_[i].children - std::uint64_t{1};
    points_.working(nodes_.bytes());
  }
  level_ = end;
}

/// The 26 cells around, as their children where they are divided already.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::gatherBreadthFirst(const Node& node) {
  p_.near.clear();
  for (unsigned i = 0; i < 27; ++i) {
    if (i == 13) continue;
    const std::array<unsigned, 3> step{i / 9, i / 3 % 3, i % 3};
    std::array<std::uint32_t, 3> cell{};
    bool outside = false;
    for (unsigned k = 0; k < 3; ++k) {
      outside |= node.cell[k] + std::uint64_t{step[k]} == 0;
      cell[k] = node.cell[k] + step[k] - 1;
    }
    if (outside) continue;
    const std::uint32_t found = nodes_.find(node.open, cell);
    if (found != Node::kNone) {
      const Node& other = nodes_[found];
      if (!other.divided()) addCell(other);
      for (unsigned c = 0; c < other.children; ++c) addCell(nodes_[other.firstChild + c]);
      continue;
    }
    for (std::uint32_t& k : cell) k >>= 1;
    const std::uint32_t larger = nodes_.find(node.open + 1U, cell);
    if (larger == Node::kNone || nodes_[larger].divided()) continue;
    const Node& other = nodes_[larger];
    if (!p_.near.holdsCell(middleOf(other, 0), middleOf(other, 1), middleOf(other, 2))) {
      addCell(other);
    }
  }
  p_.near.pad();
}

template <class Coder, class Points>
void TreeCoder<Coder, Points>::divide(Box box, unsigned axis, std::uint32_t first,
                                      std::uint32_t count) {
  if (axis == 3) {
    Node child;
    child.open = box.open[0];
    for (unsigned k = 0; k < 3; ++k) child.cell[k] = box.lower[k] >> child.open;
    child.count = count;
    child.first = first;
    if (nodes_.isAboutToGrow()) points_.working(nodes_.bytesAfterGrowth());
    nodes_.add(child);
    points_.added(cell_, nodes_.size() - 1);
    return;
  }
  const std::uint32_t upper = split(box, questionOf(box, axis), first, count);
  for (const bool half : {false, true}) {
    const std::uint32_t inHalf = half ? upper : count - upper;
    if (inHalf == 0) continue;
    Box part = box;
    part.descend(axis, half);
    divide(part, axis + 1, half ? first + (count - upper) : first, inHalf);
  }
}

template <class Coder, class Points>
void TreeCoder<Coder, Points>::walk(std::uint32_t index) {
  const Node node = nodes_[index];
  if (!node.divided()) {
    codeCell(index);
    return;
  }
  nodes_[index].firstKnown = static_cast<std::uint32_t>(known_.size());
  for (unsigned c = 0; c < node.children; ++c) walk(node.firstChild + c);
  nodes_[index].pastKnown = static_cast<std::uint32_t>(known_.size());
}

template <class Coder, class Points>
void TreeCoder<Coder, Points>::codeCell(std::uint32_t index) {
  const Node node = nodes_[index];
  nodes_[index].firstKnown = static_cast<std::uint32_t>(known_.size());
  useOrigin(node);
  p_.inCell = true;
  gatherDepthFirst(node);
  p_.startCell(known_, static_cast<float>(node.side()));
  cell_ = index;
  remaining_ = node.count;
  changed_ = true;
  Box box;
  for (unsigned k = 0; k < 3; ++k) {
    box.lower[k] = static_cast<std::uint32_t>(node.lower(k));
    box.open[k] = node.open;
  }
  if (box.isPoint()) p_.startBox(known_, questionOf(box, 0), false);
  refine(box, 0, node.first, node.count, false);
  nodes_[index].pastKnown = static_cast<std::uint32_t>(known_.size());
  points_.working(nodes_.bytes() + known_.capacity() * sizeof(KnownPoint));
}

/// A finished cell gives its points, another one its middle.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::addFinished(const Node& node) {
  if (node.divided() || !node.finished()) {
    addCell(node);
    return;
  }
  addKnown(node);
}

/// The points of a finished cell, divided or not.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::addKnown(const Node& node) {
  for (std::uint32_t i = node.firstKnown; i < node.pastKnown; ++i) {
    const GridPoint& place = known_[i].position;
    std::array<float, 3> at{};
    for (unsigned k = 0; k < 3; ++k) {
      at[k] = static_cast<float>(static_cast<std::int64_t>(place[k]) - origin_[k]) + 0.5F;
    }
    p_.near.add(at[0], at[1], at[2], 1, 1, i);
  }
}

/// The cells that touch this one, found through the eight parents around.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::gatherDepthFirst(const Node& node) {
  p_.near.clear();
  auto count = static_cast<float>(node.count);
  float area = 1;
  std::array<std::uint32_t, 8> large{};
  unsigned larges = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<std::uint32_t, 3> cell{};
    bool outside = false;
    for (unsigned k = 0; k < 3; ++k) {
      cell[k] = node.cell[k] >> 1;
      if ((corner >> k & 1) == 0) continue;
      const bool up = (node.cell[k] & 1) != 0;
      outside |= !up && cell[k] == 0;
      cell[k] = up ? cell[k] + 1 : cell[k] - 1;
    }
    if (outside) continue;
    const std::uint32_t found = nodes_.find(node.open + 1U, cell);
    if (found != Node::kNone) {
      gatherChildren(nodes_[found], node, count, area);
      continue;
    }
    for (unsigned up = 1; up <= 2; ++up) {
      for (std::uint32_t& k : cell) k >>= 1;
      const std::uint32_t larger = nodes_.find(node.open + 1U + up, cell);
      if (larger == Node::kNone) continue;
      const auto end = large.begin() + larges;
      if (!nodes_[larger].divided() && std::find(large.begin(), end, larger) == end) {
        large[larges++] = larger;
        addFinished(nodes_[larger]);
        count += static_cast<float>(nodes_[larger].count);
        area += static_cast<float>(4U << (2 * up));
      }
      break;
    }
  }
  const float spacing = static_cast<float>(node.side()) / std::sqrt(count / area);
  p_.cellSpacing = spacing >= 1 ? spacing : 1;
  p_.near.startFarther();
  if (features_.has(Features::kFartherPoints) &&
      p_.near.knownPoints() < features_.nearPoints + kSparePoints) {
    gatherFarther(node);
  }
  p_.near.pad();
}

/// The finished cells of this one's size that are one cell away.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::gatherFarther(const Node& node) {
  for (unsigned i = 0; i < 27; ++i) {
    const std::array<unsigned, 3> step{i / 9, i / 3 % 3, i % 3};
    std::array<std::uint32_t, 3> cell{};
    bool outside = false;
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t own = node.cell[k] >> 1;
      outside |= own + std::uint64_t{step[k]} == 0;
      cell[k] = own + step[k] - 1;
    }
    const std::uint32_t found = outside ? Node::kNone : nodes_.find(node.open + 1U, cell);
    if (found == Node::kNone) continue;
    for (unsigned c = 0; c < nodes_[found].children; ++c) {
      const Node& child = nodes_[nodes_[found].firstChild + c];
      if (child.finished() && distanceBetween(child, node) == 2) addKnown(child);
    }
  }
}

/// The children of a parent that touch `node`.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::gatherChildren(const Node& parent, const Node& node, float& count,
                                              float& area) {
  if (!parent.divided()) {
    addFinished(parent);
    count += static_cast<float>(parent.count);
    area += 4;
    return;
  }
  for (unsigned c = 0; c < parent.children; ++c) {
    const Node& child = nodes_[parent.firstChild + c];
    if (distanceBetween(child, node) != 1) continue;
    count += static_cast<float>(child.count);
    area += 1;
    if (!child.divided()) addFinished(child);
    for (unsigned d = 0; d < child.children; ++d) {
      const Node& grandchild = nodes_[child.firstChild + d];
      if (!grandchild.divided() || !grandchild.finished()) {
        addFinished(grandchild);
        continue;
      }
      for (unsigned e = 0; e < grandchild.children; ++e) {
        addFinished(nodes_[grandchild.firstChild + e]);
      }
    }
  }
}

// Recursion is bounded by the bits of the grid: 32 levels of cells, 96 of boxes.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::refine(Box& box, unsigned axis, std::uint32_t first,
                                      std::uint32_t count, bool halved) {
  if (box.isPoint()) {
    emit(box, count);
    return;
  }
  axis = box.openAxis(axis);
  const Question q = questionOf(box, axis);
  if (count == 1 && features_.has(Features::kResiduals)) {
    codeResiduals(box, q, first);
    return;
  }
  if (!halved || changed_) {
    p_.startBox(known_, q, count == 1);
    changed_ = false;
  }
  if (count == 1) {
    refineOne(box, axis, first);
    return;
  }
  const std::uint32_t upper = split(box, q, first, count);
  const bool whole = upper == 0 || upper == count;
  if (whole) p_.take(axis, upper != 0, false);
  for (const bool half : {false, true}) {
    const std::uint32_t inHalf = half ? upper : count - upper;
    if (inHalf == 0) continue;
    Box part = box;
    part.descend(axis, half);
    refine(part, Box::after(axis), half ? first + (count - upper) : first, inHalf, whole);
  }
}

template <class Coder, class Points>
void TreeCoder<Coder, Points>::refineOne(Box box, unsigned axis, std::uint32_t first) {
  Question q = questionOf(box, axis);
  while (!box.isPoint()) {
    axis = box.openAxis(axis);
    q.turnTo(axis, box.open[axis], box.lower[axis]);
    const bool upper = split(box, q, first, 1) != 0;
    p_.take(axis, upper, isFlatFor(q, 1));
    box.descend(axis, upper);
    q.size[axis] *= 0.5F;
    q.lower[axis] = lowerOf(box, axis);
    axis = Box::after(axis);
  }
  emit(box, 1);
}

/// The only point of a box, axis by axis.
template <class Coder, class Points>
void TreeCoder<Coder, Points>::codeResiduals(Box box, Question q, std::uint32_t first) {
  p_.startResiduals(known_, q);
  for (unsigned rank = 0; rank < 3; ++rank) {
    const unsigned axis = p_.residuals.axis(rank);
    if (box.open[axis] > 0) {
      q.turnTo(axis, box.open[axis], box.lower[axis]);
      residualModel_.startAxis(
          q, p_.residuals.expected(rank, p_.surface, p_.candidates, p_.surfaceError), p_.spacing);
    }
    while (box.open[axis] > 0) {
      const std::uint64_t middle = box.middle(axis);
      bool upper = false;
      if (middle <= extent_[axis]) {
        q.turnTo(axis, box.open[axis], box.lower[axis]);
        upper = Coder::kWriting &&
                points_.countUpper(first, 1, axis, static_cast<std::uint32_t>(middle)) != 0;
        upper = residualModel_.code(*coder_, upper, q, p_);
      }
      box.descend(axis, upper);
      q.size[axis] *= 0.5F;
      q.lower[axis] = lowerOf(box, axis);
    }
    if (rank == 2) break;
    const float place = lowerOf(box, axis) + 0.5F;
    p_.residuals.found(axis, place);
    p_.candidates.weighAt(axis, place);
  }
  emit(box, 1);
}

template <class Coder, class Points>
void TreeCoder<Coder, Points>::emit(const Box& box, std::uint32_t count) {
  const GridPoint point{box.lower[0], box.lower[1], box.lower[2]};
  Vector3 at{};
  for (unsigned k = 0; k < 3; ++k) {
    at[k] = static_cast<float>(static_cast<std::int64_t>(point[k]) - origin_[k]) + 0.5F;
  }
  remaining_ -= count;
  p_.learn(known_, point, at, remaining_ == 0);
  changed_ = true;
  points_.emit(point, count, cell_);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
