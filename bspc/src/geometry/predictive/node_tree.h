#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "entropy/lanes.h"
#include "hash_multiplier.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// A cubic cell of the octree.
struct Node {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::array<std::uint32_t, 3> cell{};  ///< lower corner, in sides of the cell
  std::uint32_t count = 0;              ///< points in it, at least 1
  std::uint32_t first = 0;              ///< the encoder's first point of it
  std::uint32_t firstChild = kNone;     ///< kNone while undivided
  std::uint32_t firstKnown = 0;         ///< its known points, once it is finished
  std::uint32_t pastKnown = kNone;      ///< kNone until then
  std::uint8_t open = 0;                ///< log2 of its side, 0 … 32
  std::uint8_t children = 0;

  bool divided() const { return firstChild != kNone; }
  bool finished() const { return pastKnown != kNone; }
  std::uint64_t side() const { return std::uint64_t{1} << open; }
  /// Lower corner along axis k, in grid steps.
  std::int64_t lower(unsigned k) const { return static_cast<std::int64_t>(cell[k]) << open; }
};

/// The nodes of an octree in one array, children of a node side by side, and an index that finds
/// them by place.
class NodeTree {
 public:
  NodeTree() { clear(); }

  void clear() {
    nodes_.clear();
    slots_.assign(kFirstSlots, Slot{});
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  Node& operator[](std::uint32_t i) { return nodes_[i]; }
  const Node& operator[](std::uint32_t i) const { return nodes_[i]; }

  void add(const Node& node) {
    if ((nodes_.size() + 1) * 2 > slots_.size()) grow();
    insert(node, size());
    nodes_.push_back(node);
  }

  /// The node of that place and size; Node::kNone if there is none.
  std::uint32_t find(unsigned open, const std::array<std::uint32_t, 3>& cell) const {
    const std::uint64_t h = hash(open, cell);
    const auto tag = static_cast<std::uint32_t>(h);
    for (std::size_t at = start(h);; at = (at + 1) & (slots_.size() - 1)) {
      const Slot& slot = slots_[at];
      if (slot.node == Node::kNone) return Node::kNone;
      if (slot.tag == tag && nodes_[slot.node].cell == cell && nodes_[slot.node].open == open) {
        return slot.node;
      }
    }
  }

  std::uint64_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + slots_.capacity() * sizeof(Slot);
  }
  /// What bytes() can become at most, for a moment, when a node is added.
  std::uint64_t bytesAfterGrowth() const { return 3 * bytes(); }
  bool isAboutToGrow() const {
    return nodes_.size() == nodes_.capacity() || (nodes_.size() + 1) * 2 > slots_.size();
  }

 private:
  struct Slot {
    std::uint32_t tag = 0;
    std::uint32_t node = Node::kNone;
  };
  static constexpr std::size_t kFirstSlots = 1024;

  std::uint64_t hash(unsigned open, const std::array<std::uint32_t, 3>& cell) const {
    std::uint64_t h = cell[0] * multiplier_;
    h = (h ^ (h >> 32)) + cell[1] * 0xC2B2AE3D27D4EB4FU;
    h = (h ^ (h >> 29)) + cell[2] * 0x165667B19E3779F9U + open;
    h *= multiplier_;
    return h ^ (h >> 32);
  }
  std::size_t start(std::uint64_t h) const { return (h >> 20) & (slots_.size() - 1); }

  void insert(const Node& node, std::uint32_t index) {
    const std::uint64_t h = hash(node.open, node.cell);
    std::size_t at = start(h);
    while (slots_[at].node != Node::kNone) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {static_cast<std::uint32_t>(h), index};
  }

  void grow() {
    slots_.assign(2 * slots_.size(), Slot{});
    for (std::uint32_t i = 0; i < size(); ++i) insert(nodes_[i], i);
  }

  std::uint64_t multiplier_ = hashMultiplier();
  std::vector<Node> nodes_;
  std::vector<Slot> slots_;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
