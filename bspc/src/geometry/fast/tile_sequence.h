#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::geometry::fast {

/// Which points of a tile belong to which layer. The points stand in a sequence; the points of
/// layers 0 … l are every stride(l)-th of it, and each stands for those up to the next one.
class LayerStrides {
 public:
  static constexpr unsigned kMaxRatioBits = 16;

  /// From layer to layer the stride shrinks by 2^ratioBits.
  LayerStrides(std::uint64_t points, unsigned layers, unsigned ratioBits)
      : points_(points), layers_(layers), ratioBits_(ratioBits) {}

  /// log2 of the stride; beyond every sequence from some point on.
  unsigned strideBits(unsigned layer) const {
    const unsigned bits = ratioBits_ * (layers_ - 1 - layer);
    return bits < 63 ? bits : 63;
  }
  /// Points of layers 0 … `layer`.
  std::uint64_t upTo(unsigned layer) const {
    return points_ == 0 ? 0 : ((points_ - 1) >> strideBits(layer)) + 1;
  }
  std::uint64_t inLayer(unsigned layer) const {
    return upTo(layer) - (layer > 0 ? upTo(layer - 1) : 0);
  }
  /// Places among the points of layers 0 … `layer`, which stand in the order of the sequence, layer
  /// after layer.
  std::vector<std::uint32_t> layerAfterLayer(unsigned layer) const;
  /// Whether the point at a place of the sequence comes with that very layer.
  bool isNew(std::uint64_t place, unsigned layer) const {
    const auto onStride = [&](unsigned l) {
      return (place & ((std::uint64_t{1} << strideBits(l)) - 1)) == 0;
    };
    return onStride(layer) && (layer == 0 || !onStride(layer - 1));
  }

 private:
  std::uint64_t points_;
  unsigned layers_;
  unsigned ratioBits_;
};

/// Indices of the points along the Hilbert curve of a box with that extent; points of one place are
/// in order of their coordinates x, y, z.
std::vector<std::uint32_t> hilbertSequence(const std::vector<GridPoint>& points,
                                           const GridPoint& extent);

}  // namespace bspc::geometry::fast
