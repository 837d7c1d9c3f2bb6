#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Method `predictive`: an octree whose every decision is predicted from what is decoded around it
/// (planes, quadrics, repeated spacings, repeated coordinates …), mixed in the logistic domain.
/// The smallest files; docs/format.md, "Method predictive".
class PredictiveMethod final : public GeometryMethod {
 public:
  Method id() const override { return Method::Predictive; }
  unsigned version() const override { return 0; }
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;
};

}  // namespace bspc::geometry
