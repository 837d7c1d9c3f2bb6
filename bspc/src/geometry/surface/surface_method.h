#pragma once

#include "connectivity/surface_faces.h"
#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Positions along the faces of a mesh: first its faces, without places; then vertex after vertex,
/// each predicted from those around it. Without faces it only works.
class SurfaceMethod : public GeometryMethod {
 public:
  Method id() const override { return Method::Surface; }
  unsigned version() const override { return 0; }
  std::uint64_t maxPoints() const override;
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;
};

/// The faces in the payload of a tile's last layer, over its points as they are decoded. Throws
/// Error(Corrupt, LimitExceeded); any bytes are safe. `working` is called from time to time; it may
/// throw to stop.
Cells facesOfSurface(ByteView payload, std::uint64_t points, std::uint64_t maxBytes,
                     const std::function<void()>& working = nullptr);

}  // namespace bspc::geometry
