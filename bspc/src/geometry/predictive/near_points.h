#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/logistic_math.h"
#include "geometry/predictive/known_points.h"
#include "geometry/predictive/neighbourhood.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// The known points nearest to the cell at hand, those decoded in it added as they come.
struct NearPoints {
  static constexpr unsigned kMost = 32;

  unsigned count = 0;
  alignas(32) float x[kMost];
  alignas(32) float y[kMost];
  alignas(32) float z[kMost];
  std::uint32_t known[kMost];  ///< indices of known points

  const float* along(unsigned axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

  /// The `wanted` points of the neighbourhood that are nearest to a place; nearest first.
  void gather(const Neighbourhood& near, float px, float py, float pz, unsigned wanted) {
    count = 0;
    for (unsigned i = 0; i < kMost; ++i) x[i] = y[i] = z[i] = Neighbourhood::kNowhere;
    alignas(32) float distance[Neighbourhood::kRoom];
    for (unsigned i = 0; i < entropy::wholeLanes(near.count); i += entropy::kLanes) {
      const entropy::Lanes dx = entropy::load(near.x + i) - px;
      const entropy::Lanes dy = entropy::load(near.y + i) - py;
      const entropy::Lanes dz = entropy::load(near.z + i) - pz;
      entropy::store(distance + i, dx * dx + dy * dy + dz * dz);
    }
    std::uint32_t key[kMost];
    for (unsigned i = 0; i < near.count; ++i) {
      if (near.known[i] == Neighbourhood::kCell) continue;
      insert(key, count, wanted, keyOf(distance[i], i));
    }
    for (unsigned i = 0; i < count; ++i) {
      const std::uint32_t j = key[i] & kIndexMask;
      x[i] = near.x[j];
      y[i] = near.y[j];
      z[i] = near.z[j];
      known[i] = near.known[j];
    }
  }

  bool full() const { return count + 1 >= kMost; }
  void add(float px, float py, float pz, std::uint32_t index) {
    x[count] = px;
    y[count] = py;
    z[count] = pz;
    known[count] = index;
    ++count;
  }

  struct Nearest {
    unsigned index = 0;
    float square = 0;
  };
  /// The first of the points nearest to a place, and the square of its distance.
  Nearest nearestTo(float px, float py, float pz) const {
    alignas(32) float distance[kMost];
    entropy::Lanes best = entropy::Lanes(Neighbourhood::kNowhere * Neighbourhood::kNowhere);
    for (unsigned i = 0; i < entropy::wholeLanes(count); i += entropy::kLanes) {
      const entropy::Lanes dx = entropy::load(x + i) - px;
      const entropy::Lanes dy = entropy::load(y + i) - py;
      const entropy::Lanes dz = entropy::load(z + i) - pz;
      const entropy::Lanes square = dx * dx + dy * dy + dz * dz;
      entropy::store(distance + i, square);
      best = entropy::smaller(best, square);
    }
    Nearest nearest;
    nearest.square = entropy::least(best);
    while (nearest.index + 1 < count && distance[nearest.index] > nearest.square) ++nearest.index;
    return nearest;
  }

  /// Calls `visit` with the indices of the six known points nearest to a place.
  template <class Visit>
  unsigned visitSix(float px, float py, float pz, Visit visit) const {
    constexpr unsigned kSix = 6;
    constexpr unsigned kGroups = kMost / entropy::kLanes;
    alignas(32) std::int32_t key[kMost];
    std::array<entropy::IntLanes, kGroups> keys;
    const unsigned groups = entropy::wholeLanes(count) / unsigned{entropy::kLanes};
    for (unsigned g = 0; g < groups; ++g) {
      const unsigned i = g * entropy::kLanes;
      const entropy::Lanes dx = entropy::load(x + i) - px;
      const entropy::Lanes dy = entropy::load(y + i) - py;
      const entropy::Lanes dz = entropy::load(z + i) - pz;
      const entropy::IntLanes bits = entropy::bitsOf(dx * dx + dy * dy + dz * dz);
      keys[g] = (bits & ~static_cast<std::int32_t>(kIndexMask)) | entropy::laneNumbers(i);
      entropy::store(key + i, keys[g]);
    }
    // How many are nearer than each: no branch depends on distances.
    std::array<entropy::IntLanes, kGroups> nearer{};
    for (unsigned j = 0; j < count; ++j) {
      for (unsigned g = 0; g < groups; ++g) {
        nearer[g] = nearer[g] - (entropy::IntLanes(key[j]) < keys[g]);
      }
    }
    alignas(32) std::int32_t rank[kMost];
    for (unsigned g = 0; g < groups; ++g) entropy::store(rank + g * entropy::kLanes, nearer[g]);
    std::array<std::uint8_t, kMost + 1> order{};
    for (unsigned i = 0; i < count; ++i)
      order[static_cast<unsigned>(rank[i])] = static_cast<std::uint8_t>(i);
    const unsigned found = std::min(count, kSix);
    for (unsigned i = 0; i < found; ++i) visit(known[order[i]]);
    return found;
  }

 private:
  static constexpr std::uint32_t kIndexMask = 127;
  static_assert(Neighbourhood::kRoom <= kIndexMask + 1, "an index has seven bits in a key");

  /// Orders by distance (rounded a little), then by index.
  static std::uint32_t keyOf(float distance, unsigned index) {
    return (entropy::bitsOf(distance) & ~kIndexMask) | index;
  }
  static void insert(std::uint32_t* keys, unsigned& found, unsigned wanted, std::uint32_t key) {
    if (found == wanted && key >= keys[found - 1]) return;
    unsigned at = found < wanted ? found++ : found - 1;
    for (; at > 0 && keys[at - 1] > key; --at) keys[at] = keys[at - 1];
    keys[at] = key;
  }
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
