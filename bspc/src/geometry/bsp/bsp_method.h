#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Method `bsp`: "Point set compression through BSP quantization" (Bordignon, Lewiner, Lopes,
/// Tavares, Castro 2006), in integers and without loss on the grid unless asked for: cells are cut
/// along the principal direction of their points, with planes that are the more coarsely quantised
/// the fewer the points are. docs/format.md, "Method bsp".
class BspMethod final : public GeometryMethod {
 public:
  static constexpr unsigned kMaxBits = 21;  ///< of the grid, along each axis

  Method id() const override { return Method::Bsp; }
  unsigned version() const override { return 0; }
  unsigned maxBits() const override { return kMaxBits; }
  bool canStop() const override { return true; }
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;
};

}  // namespace bspc::geometry
