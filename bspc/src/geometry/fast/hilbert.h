#pragma once

#include <array>
#include <cstdint>

#include "bspc/grid.h"

namespace bspc::geometry::fast {

/// The plane's Hilbert curve; places are found four levels a step. A state is how the curve lies in
/// a square: bit 0 exchanges the axes, bit 1 reverses both.
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

  /// The inverse of place(): x · 2^16 + y. Higher bits of the place are ignored. Without tables or
  /// branches, so that compilers take many places at once.
  static std::uint32_t position(std::uint32_t place, unsigned levels) {
    constexpr std::uint32_t kEach = 0x00555555;  // one bit of each digit
    place &= (std::uint32_t{1} << (2 * levels)) - 1;
    const std::uint32_t x = (place >> 1) & kEach;
    const std::uint32_t differ = place & kEach;
    // How the curve lies in a square is what all digits above make of it: 0 and 3 exchange the
    // axes, 3 also reverses both. Leading zeros are an even number and change nothing.
    std::uint32_t state = (~(x ^ differ) & kEach) | ((x & differ) << 1);
    state >>= 2;
    state ^= state >> 2;
    state ^= state >> 4;
    state ^= state >> 8;
    state ^= state >> 16;
    const std::uint32_t turned = x ^ (differ & state) ^ ((state >> 1) & kEach);
    return gathered((turned << 1) | (turned ^ differ));
  }

 private:
  HilbertPlane();

  /// The odd bits side by side in the upper half, the even ones in the lower.
  static std::uint32_t gathered(std::uint32_t bits) {
    const auto exchange = [&bits](std::uint32_t mask, unsigned by) {
      const std::uint32_t change = (bits ^ (bits >> by)) & mask;
      bits ^= change ^ (change << by);
    };
    exchange(0x22222222, 1);
    exchange(0x0C0C0C0C, 2);
    exchange(0x00F000F0, 4);
    exchange(0x0000FF00, 8);
    return bits;
  }

  std::array<std::array<std::uint16_t, 256>, 4> place_{};
};

/// Place of a point along the Hilbert curve of a cube of 2^bits steps a side, bits ≤ 32; the
/// coordinates' leading 16 bits count (docs/format.md, "Method fast").
std::uint64_t hilbertPlaceInSpace(const GridPoint& point, unsigned bits);

}  // namespace bspc::geometry::fast
