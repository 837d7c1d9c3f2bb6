#include "geometry/fast/hilbert.h"

#include <utility>

namespace bspc::geometry::fast {

namespace {

constexpr unsigned kSpaceLevels = 16;

constexpr unsigned rotateLeft3(unsigned v, unsigned by) {
  by %= 3;
  return ((v << by) | (v >> (3 - by))) & 7;
}

/// The curve in space after Hamilton, "Compact Hilbert indices" (2006): a state is the corner where
/// the curve enters a cube (three bits) and the axis along which it leaves.
struct SpaceStep {
  std::uint8_t digit;
  std::uint8_t state;
};

constexpr std::array<std::array<SpaceStep, 8>, 24> spaceSteps() {
  // Where the curve enters the w-th octant, and the axis along which it passes it.
  constexpr unsigned entry[8] = {0, 0, 0, 3, 3, 6, 6, 5};
  constexpr unsigned axis[8] = {0, 1, 1, 2, 2, 1, 1, 0};
  std::array<std::array<SpaceStep, 8>, 24> steps{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned d = 0; d < 3; ++d) {
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned turned = rotateLeft3(octant ^ corner, 3 - (d + 1) % 3);
        const unsigned w = turned ^ (turned >> 1) ^ (turned >> 2);
        const unsigned nextCorner = corner ^ rotateLeft3(entry[w], d + 1);
        const unsigned nextAxis = (d + axis[w] + 1) % 3;
        steps[3 * corner + d][octant] = {static_cast<std::uint8_t>(w),
                                         static_cast<std::uint8_t>(3 * nextCorner + nextAxis)};
      }
    }
  }
  return steps;
}

/// Two levels in one step: indexed by two bits of x, then of y, then of z.
using DoubleSteps = std::array<std::array<SpaceStep, 64>, 24>;

DoubleSteps doubleSteps(const std::array<std::array<SpaceStep, 8>, 24>& steps) {
  DoubleSteps twice{};
  for (unsigned state = 0; state < 24; ++state) {
    for (unsigned xyz = 0; xyz < 64; ++xyz) {
      const unsigned x = xyz & 3;
      const unsigned y = (xyz >> 2) & 3;
      const unsigned z = xyz >> 4;
      const SpaceStep first = steps[state][(x >> 1) | (y & 2) | ((z & 2) << 1)];
      const SpaceStep second = steps[first.state][(x & 1) | ((y & 1) << 1) | ((z & 1) << 2)];
      twice[state][xyz] = {static_cast<std::uint8_t>((first.digit << 3) | second.digit),
                           second.state};
    }
  }
  return twice;
}

}  // namespace

const HilbertPlane& HilbertPlane::instance() {
  static const HilbertPlane curve;
  return curve;
}

HilbertPlane::HilbertPlane() {
  for (unsigned first = 0; first < 4; ++first) {
    for (unsigned xy = 0; xy < 256; ++xy) {
      unsigned state = first;
      unsigned place = 0;
      for (unsigned level = 4; level-- > 0;) {
        unsigned x = (xy >> (4 + level)) & 1;
        unsigned y = (xy >> level) & 1;
        if ((state & 2) != 0) {
          x ^= 1;
          y ^= 1;
        }
        if ((state & 1) != 0) std::swap(x, y);
        place = (place << 2) | ((3 * x) ^ y);
        if (y == 0) state ^= x != 0 ? 3 : 1;
      }
      place_[first][xy] = static_cast<std::uint16_t>(place | (state << 8));
    }
  }
}

std::uint64_t hilbertPlaceInSpace(const GridPoint& point, unsigned bits) {
  static constexpr auto kSteps = spaceSteps();
  static const DoubleSteps kDouble = doubleSteps(kSteps);
  unsigned levels = bits < kSpaceLevels ? bits : kSpaceLevels;
  unsigned shift = bits;
  std::uint64_t place = 0;
  unsigned state = 0;
  if (levels % 2 != 0) {
    --shift;
    const unsigned octant = ((point[0] >> shift) & 1) | (((point[1] >> shift) & 1) << 1) |
                            (((point[2] >> shift) & 1) << 2);
    place = kSteps[state][octant].digit;
    state = kSteps[state][octant].state;
  }
  for (levels /= 2; levels > 0; --levels) {
    shift -= 2;
    const unsigned octants = ((point[0] >> shift) & 3) | (((point[1] >> shift) & 3) << 2) |
                             (((point[2] >> shift) & 3) << 4);
    const SpaceStep step = kDouble[state][octants];
    place = (place << 6) | step.digit;
    state = step.state;
  }
  return place;
}

}  // namespace bspc::geometry::fast
