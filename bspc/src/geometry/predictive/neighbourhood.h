#pragma once

#include <algorithm>
#include <cstdint>

#include "entropy/lanes.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// What is known around the cell at hand: single points, and cells that are still to be divided.
struct Neighbourhood {
  static constexpr unsigned kMost = 104;
  static constexpr unsigned kRoom = kMost + 16;  ///< for points of the cell itself
  static constexpr std::uint32_t kCell = 0xFFFFFFFF;
  /// Where the padding lies; its square does not overflow.
  static constexpr float kNowhere = 1e18F;

  unsigned count = 0;
  unsigned touching = 0;  ///< entries in front of those that lie farther off
  alignas(32) float x[kRoom];
  alignas(32) float y[kRoom];
  alignas(32) float z[kRoom];
  alignas(32) float weight[kRoom];  ///< number of points; 0 for padding
  alignas(32) float size[kRoom];    ///< side in grid steps, 1 for a point
  std::uint32_t known[kRoom];       ///< index of the known point; kCell for a cell

  void clear() { count = 0; }

  void add(float px, float py, float pz, float points, float side, std::uint32_t index) {
    if (count < kMost) put(px, py, pz, points, side, index);
  }

  /// A point of the cell at hand that has just been decoded.
  void addDecoded(float px, float py, float pz, std::uint32_t index) {
    if (count + 1 >= kRoom) return;
    put(px, py, pz, 1, 1, index);
    pad();
  }

  void pad() {
    for (auto i = count; i < entropy::wholeLanes(count); ++i) {
      x[i] = y[i] = z[i] = kNowhere;
      weight[i] = 0;
      size[i] = 1;
    }
  }

  /// From now on entries lie farther off, until forgetFarther().
  void startFarther() { touching = count; }
  void forgetFarther() {
    count = touching;
    pad();
  }

  unsigned knownPoints() const {
    return static_cast<unsigned>(
        std::count_if(known, known + count, [](std::uint32_t i) { return i != kCell; }));
  }

  bool holdsCell(float px, float py, float pz) const {
    for (unsigned i = 0; i < count; ++i) {
      if (x[i] == px && y[i] == py && z[i] == pz) return true;
    }
    return false;
  }

 private:
  void put(float px, float py, float pz, float points, float side, std::uint32_t index) {
    x[count] = px;
    y[count] = py;
    z[count] = pz;
    weight[count] = points;
    size[count] = side;
    known[count] = index;
    ++count;
  }
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
