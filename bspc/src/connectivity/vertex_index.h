#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/span.h"

namespace bspc::connectivity {

using Position = std::array<double, 3>;

/// A vertex and its squared distance from where neighbours were asked for.
struct Neighbour {
  double distance = 0;
  std::uint32_t vertex = 0;
};

/// Finds the nearest vertices of a place: a kd-tree in which vertices can be put to sleep and woken
/// again. What it returns depends on positions and numbers alone, not on the shape of the tree.
class VertexIndex {
 public:
  /// The positions must outlive this. All vertices are awake.
  explicit VertexIndex(Span<const Position> positions);

  void putToSleep(std::uint32_t vertex);
  void wake(std::uint32_t vertex);

  enum class Among { Awake, All };

  /// The `count` ≥ 1 vertices nearest to `place` / 2, by distance and then by number. Distances
  /// are those of doubled positions from `place`: Σ (2 p − place)², added in the order x, y, z.
  void nearest(const Position& place, std::size_t count, Among among,
               std::vector<Neighbour>& found) const;

 private:
  struct Node {
    Position lower{};
    Position upper{};
    std::uint32_t first = 0;  ///< of its entries
    std::uint32_t last = 0;
    std::uint32_t left = 0;  ///< 0: a leaf
    std::uint32_t right = 0;
    std::uint32_t parent = 0;
    std::uint32_t awake = 0;
    std::uint32_t smallest = 0;  ///< number of a vertex
  };
  struct Search;

  std::uint32_t build(std::vector<std::uint32_t>& order, std::uint32_t first, std::uint32_t last,
                      std::uint32_t parent);
  void addToPath(std::uint32_t vertex, std::uint32_t change);

  /// A vertex where the tree has it.
  struct Entry {
    Position doubled{};
    std::uint32_t vertex = 0;
    std::uint32_t awake = 1;
  };

  Span<const Position> positions_;
  std::vector<Node> nodes_;  ///< their boxes are doubled too
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> placeOf_;  ///< of each vertex in entries_
  std::vector<std::uint32_t> leafOf_;   ///< of each vertex
};

}  // namespace bspc::connectivity
