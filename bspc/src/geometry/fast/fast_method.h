#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// The quick method: slabs of points over a plane, their heights predicted by planes and quadrics.
/// Efforts 1 … 4 go from the quickest to the smallest.
class FastMethod final : public GeometryMethod {
 public:
  Method id() const override { return Method::Fast; }
  unsigned version() const override { return 0; }
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;
};

}  // namespace bspc::geometry
