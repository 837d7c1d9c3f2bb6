#pragma once

#include <optional>

#include "bspc/grid.h"
#include "bspc/span.h"
#include "geometry/predictive/pinhole_camera.h"

namespace bspc::geometry::predictive {

/// The encoder's search for the depth camera that took the points, of whatever position along the
/// axes, focal lengths, and centre of the picture; none where the points do not look like that.
/// `extent`: greatest coordinates. Sets that are no range images are mostly refused after one look
/// at their coordinates.
std::optional<PinholeCamera> findCamera(Span<const GridPoint> points, const GridPoint& extent);

}  // namespace bspc::geometry::predictive
