#pragma once

#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// The axis-aligned partitions of the paper's Table 1 that have no counts (docs/format.md, "Methods
/// octree and gencode"): `octree` is [1], `gencode` is [7].
template <class Symbols>
class PartitionMethod final : public GeometryMethod {
 public:
  static constexpr unsigned kMaxBits = 21;

  explicit PartitionMethod(Method id) : id_(id) {}

  Method id() const override { return id_; }
  unsigned version() const override { return 0; }
  unsigned maxBits() const override { return kMaxBits; }
  EncodedTile encode(const TileInput& tile, const PointProgress& progress) const override;
  DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const override;

 private:
  Method id_;
};

const GeometryMethod& octreeMethod();
const GeometryMethod& genCodeMethod();

}  // namespace bspc::geometry
