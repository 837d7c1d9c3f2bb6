#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::geometry::predictive {

/// A plane across an axis in which a set is mirrored: coordinate x goes to sum − x.
struct MirrorPlane {
  unsigned axis = 0;
  std::uint64_t sum = 0;  ///< twice the plane's coordinate

  /// Points on the lower side or on the plane itself are coded first.
  bool isOriginal(const GridPoint& p) const { return 2 * std::uint64_t{p[axis]} <= sum; }
  /// The axes in the order that copies are coded in.
  std::array<unsigned, 3> axes() const { return {axis, (axis + 1) % 3, (axis + 2) % 3}; }
};

/// Where a copy lies beside the exact mirror image, along MirrorPlane::axes(): −1, 0 or 1 each.
using MirrorOffset = std::array<std::int8_t, 3>;

/// The encoder's search: the plane that mirrors most points to within a step of others; none if
/// that is less than about a third. Looks at every point a few times, whatever it finds.
std::optional<MirrorPlane> findMirrorPlane(Span<const GridPoint> points);

struct MirrorMatches {
  std::vector<std::optional<MirrorOffset>> offsets;  ///< for each original
  std::vector<std::uint32_t> copies;                 ///< for each original: its copy, if it has one
  std::vector<std::uint32_t> unmatched;              ///< the others that are no one's copy
};

/// The encoder's assignment of copies to originals. Offsets that are frequent go first, so that
/// few different ones occur.
MirrorMatches matchMirrored(const MirrorPlane& plane, Span<const GridPoint> originals,
                            Span<const GridPoint> others);

}  // namespace bspc::geometry::predictive
