#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Method `kd`: the kd-tree of Gandoin and Devillers, "Progressive lossless compression of
/// arbitrary simplicial complexes" (2002), [4] of the paper: cells are halved across their longest
/// side, and the number of points in one half is coded, with adaptive models. docs/format.md,
/// "Method kd".
class KdMethod final : public GeometryMethod {
 public:
  Method id() const override { return Method::Kd; }
  unsigned version() const override { return 1; }
  bool canStop() const override { return true; }
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;
};

}  // namespace bspc::geometry
