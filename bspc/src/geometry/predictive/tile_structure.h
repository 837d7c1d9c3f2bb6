#pragma once

#include <optional>

#include "bspc/grid.h"
#include "bspc/span.h"
#include "geometry/predictive/features.h"
#include "geometry/predictive/mirror_plane.h"
#include "geometry/predictive/phase_lattice.h"
#include "geometry/predictive/range_image.h"

namespace bspc::geometry::predictive {

/// What the encoder finds in a tile as a whole.
struct TileStructure {
  std::array<std::uint32_t, 3> phases{};  ///< frequency of each axis's lattice, 0 for none
  std::optional<RangeImage> image;
  std::optional<MirrorPlane> plane;  ///< not sought if there is an image

  /// Whether the points are to be coded otherwise than by one tree.
  bool isSpecial() const { return image || plane; }
};

/// `points`: of the tile, from its lower corner; `extent`: the greatest coordinates.
TileStructure findStructure(Span<const GridPoint> points, const GridPoint& extent,
                            const Features& features);

}  // namespace bspc::geometry::predictive
