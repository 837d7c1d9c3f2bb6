#pragma once

#include <array>
#include <cstdint>

#include "bspc/grid.h"

namespace bspc::geometry::fast {

/// The plane's Hilbert curve, four levels a step. A state is how the curve lies in a square: bit 0
/// exchanges the axes, bit 1 reverses both.
class HilbertPlane {
 public:
  static const HilbertPlane& instance();

  /// Place along the curve of a position of `levels` bits per axis, levels ≤ 12, a multiple of 4.
  std::uint32_t place(std::uint32_t x, std::uint32_t y, unsigned levels) const {
    std::uint32_t place = 0;
    unsigned state = 0;
    for (unsigned shift = levels; shift > 0;) {
      shift -= 4;
      const std::uint16_t e = place_[state][(((x >> shift) & 15) << 4) | ((y >> shift) & 15)];
      place = (place << 8) | (e & 0xFFU);
      state = e >> 8;
    }
    return place;
  }

  /// The inverse of place(): x · 2^16 + y. Higher bits of the place are ignored.
  std::uint32_t position(std::uint32_t place, unsigned levels) const {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    unsigned state = 0;
    for (unsigned shift = 2 * levels; shift > 0;) {
      shift -= 8;
      const std::uint16_t e = position_[state][(place >> shift) & 0xFF];
      x = (x << 4) | ((e >> 4) & 15U);
      y = (y << 4) | (e & 15U);
      state = e >> 8;
    }
    return (x << 16) | y;
  }

 private:
  HilbertPlane();

  std::array<std::array<std::uint16_t, 256>, 4> place_{};
  std::array<std::array<std::uint16_t, 256>, 4> position_{};
};

/// Place of a point along the Hilbert curve of a cube of 2^bits steps a side, bits ≤ 32; the
/// coordinates' leading 16 bits count (docs/format.md, "Method fast").
std::uint64_t hilbertPlaceInSpace(const GridPoint& point, unsigned bits);

}  // namespace bspc::geometry::fast
