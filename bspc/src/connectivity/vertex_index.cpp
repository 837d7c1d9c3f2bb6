#include "connectivity/vertex_index.h"

#include <algorithm>
#include <numeric>

namespace bspc::connectivity {

namespace {

constexpr std::uint32_t kLeaf = 8;
constexpr std::uint32_t kNone = 0xFFFFFFFF;

bool nearer(const Neighbour& a, const Neighbour& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
}

}  // namespace

VertexIndex::VertexIndex(Span<const Position> positions)
    : positions_(positions),
      entries_(positions.size()),
      placeOf_(positions.size()),
      leafOf_(positions.size()) {
  if (positions.empty()) return;
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(positions.size() / 3 + 1);
  build(order, 0, static_cast<std::uint32_t>(positions.size()), kNone);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) entries_[i].doubled[k] = 2 * positions[order[i]][k];
    entries_[i].vertex = order[i];
    placeOf_[order[i]] = i;
  }
}

// Recursion is bounded: every level halves the number of vertices.
std::uint32_t VertexIndex::build(std::vector<std::uint32_t>& order, std::uint32_t first,
                                 std::uint32_t last, std::uint32_t parent) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.first = first;
  node.last = last;
  node.parent = parent;
  node.awake = last - first;
  node.smallest = *std::min_element(order.begin() + first, order.begin() + last);
  node.lower = node.upper = positions_[order[first]];
  for (std::uint32_t i = first; i < last; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      node.lower[k] = std::min(node.lower[k], positions_[order[i]][k]);
      node.upper[k] = std::max(node.upper[k], positions_[order[i]][k]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (node.upper[k] - node.lower[k] > node.upper[axis] - node.lower[axis]) axis = k;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    node.lower[k] *= 2;
    node.upper[k] *= 2;
  }
  nodes_.push_back(node);
  if (last - first <= kLeaf) {
    for (std::uint32_t i = first; i < last; ++i) leafOf_[order[i]] = id;
    return id;
  }
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = positions_[a][axis];
                     const double y = positions_[b][axis];
                     return x != y ? x < y : a < b;
                   });
  const std::uint32_t left = build(order, first, middle, id);
  const std::uint32_t right = build(order, middle, last, id);
  nodes_[id].left = left;
  nodes_[id].right = right;
  return id;
}

void VertexIndex::addToPath(std::uint32_t vertex, std::uint32_t change) {
  for (std::uint32_t id = leafOf_[vertex]; id != kNone; id = nodes_[id].parent) {
    nodes_[id].awake += change;
  }
}

void VertexIndex::putToSleep(std::uint32_t vertex) {
  Entry& entry = entries_[placeOf_[vertex]];
  if (entry.awake == 0) return;
  entry.awake = 0;
  addToPath(vertex, 0U - 1U);
}

void VertexIndex::wake(std::uint32_t vertex) {
  Entry& entry = entries_[placeOf_[vertex]];
  if (entry.awake != 0) return;
  entry.awake = 1;
  addToPath(vertex, 1);
}

struct VertexIndex::Search {
  const VertexIndex& index;
  const Position& place;
  std::size_t count;
  bool all;
  std::vector<Neighbour>& found;

  /// Not farther than any vertex of the node, also after rounding: the same sum of smaller terms.
  double distanceOf(const Node& node) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = node.lower[k] - place[k];
      const double high = node.upper[k] - place[k];
      const double gap = low > 0 ? low : high < 0 ? high : 0;
      sum += gap * gap;
    }
    return sum;
  }

  /// Whether no vertex of a node at that distance can be one of the nearest. Of those as far as the
  /// last one found, however many lie in one place, only smaller numbers can.
  bool tooFar(const Node& node, double distance) const {
    return found.size() == count && !nearer({distance, node.smallest}, found.back());
  }

  void visitLeaf(const Node& node) {
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      const Entry& entry = index.entries_[i];
      if (!all && entry.awake == 0) continue;
      Neighbour candidate;
      candidate.vertex = entry.vertex;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = entry.doubled[k] - place[k];
        candidate.distance += d * d;
      }
      if (found.size() == count) {
        if (!nearer(candidate, found.back())) continue;
        found.pop_back();
      }
      found.push_back(candidate);
      for (std::size_t j = found.size() - 1; j > 0 && nearer(found[j], found[j - 1]); --j) {
        std::swap(found[j], found[j - 1]);
      }
    }
  }

  // Recursion is bounded by the depth of the tree.
  void visit(std::uint32_t id, double distance) {
    const Node& node = index.nodes_[id];
    if ((!all && node.awake == 0) || tooFar(node, distance)) return;
    if (node.left == 0) {
      visitLeaf(node);
      return;
    }
    const double left = distanceOf(index.nodes_[node.left]);
    const double right = distanceOf(index.nodes_[node.right]);
    const bool leftFirst =
        left != right ? left < right
                      : index.nodes_[node.left].smallest < index.nodes_[node.right].smallest;
    if (leftFirst) {
      visit(node.left, left);
      visit(node.right, right);
    } else {
      visit(node.right, right);
      visit(node.left, left);
    }
  }
};

void VertexIndex::nearest(const Position& place, std::size_t count, Among among,
                          std::vector<Neighbour>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  Search search{*this, place, count, among == Among::All, found};
  search.visit(0, 0);
}

}  // namespace bspc::connectivity
