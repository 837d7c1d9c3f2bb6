#include "geometry/predictive/tile_structure.h"

#include "geometry/predictive/camera_fit.h"

namespace bspc::geometry::predictive {

TileStructure findStructure(Span<const GridPoint> points, const GridPoint& extent,
                            const Features& features) {
  TileStructure structure;
  if (features.has(Features::kPhase)) {
    for (unsigned k = 0; k < 3; ++k) structure.phases[k] = findPhaseFrequency(points, k);
  }
  if (features.has(Features::kRangeImage)) {
    if (const auto camera = findCamera(points, extent)) {
      structure.image = arrangeRangeImage(points, extent, *camera);
    }
  }
  if (features.has(Features::kMirror) && !structure.image) {
    structure.plane = findMirrorPlane(points);
  }
  return structure;
}

}  // namespace bspc::geometry::predictive
