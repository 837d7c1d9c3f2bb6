#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/fast/bit_stream.h"
#include "geometry/fast/cell.h"
#include "geometry/fast/hilbert.h"

namespace bspc::geometry::fast {

/// Place of (u, v) along a slab's curve: the Hilbert curve's place, then the bits below.
inline std::uint64_t codeOf(const HilbertPlane& curve, const SlabFrame& frame, std::uint32_t u,
                            std::uint32_t v) {
  const std::uint64_t place =
      curve.place(u >> frame.below[0], v >> frame.below[1], frame.curveLevels);
  return (((place << frame.below[0]) | (u & lowBits(frame.below[0]))) << frame.below[1]) |
         (v & lowBits(frame.below[1]));
}

/// The inverse of codeOf(), for `count` codes. Codes that are too large give wrong positions.
inline void positionsOfCodes(const SlabFrame& frame, const std::uint64_t* codes, std::size_t count,
                             std::uint32_t* u, std::uint32_t* v) {
  const unsigned bu = frame.below[0];
  const unsigned bv = frame.below[1];
  const unsigned levels = frame.curveLevels;
  const auto maskU = static_cast<std::uint32_t>(lowBits(bu));
  const auto maskV = static_cast<std::uint32_t>(lowBits(bv));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t code = codes[i];
    const std::uint32_t xy =
        HilbertPlane::position(static_cast<std::uint32_t>(code >> (bu + bv)), levels);
    u[i] = ((xy >> 16) << bu) | (static_cast<std::uint32_t>(code >> bv) & maskU);
    v[i] = ((xy & 0xFFFF) << bv) | (static_cast<std::uint32_t>(code) & maskV);
  }
}

}  // namespace bspc::geometry::fast
