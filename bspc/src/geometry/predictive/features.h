#pragma once

#include <cstdint>

namespace bspc::geometry::predictive {

/// What the coder of a tile takes into account. The encoder chooses, the tile's header says;
/// efforts are presets of it.
struct Features {
  enum Flag : std::uint32_t {
    kQuadric = 1U << 0,          ///< a quadric is fitted, not only a plane
    kPlane = 1U << 1,            ///< the plane is evidence beside the quadric
    kParallelograms = 1U << 2,   ///< candidates a + b − c
    kProjection = 1U << 3,       ///< candidates once more, moved onto the quadric
    kSeparateKinds = 1U << 4,    ///< the two kinds of candidates are separate evidence
    kTwoScales = 1U << 5,        ///< candidates count at two widths rather than one
    kAxisValues = 1U << 6,       ///< coordinates used before
    kWideCoordinates = 1U << 7,  ///< coordinates of near points at a second width
    kDensity = 1U << 8,          ///< how many points lie on either side
    kNearest = 1U << 9,          ///< distance of either half to the nearest point
    kManyContexts = 1U << 10,    ///< more contexts of side decisions: six, two in two layers
    kPhase = 1U << 11,           ///< a lattice finer than the grid or offset from it
    kMirror = 1U << 12,          ///< mirrored copies
    kRangeImage = 1U << 13,      ///< raster of a depth camera
    kTwoLayers = 1U << 14,       ///< side and count decisions are mixed in two layers
    kNarrowQuadric = 1U << 15,   ///< the quadric once more, as if it erred less
    kFartherPoints = 1U << 16,   ///< where few points are known around, those a cell farther off
    kChains = 1U << 17,          ///< rows of three points bend where they go on
    kResiduals = 1U << 18,       ///< lone points are coded axis by axis (AxisResiduals)
  };
  static constexpr std::uint32_t kAllFlags = (1U << 19) - 1;
  /// Whatever makes files smaller; residuals make coding quicker.
  static constexpr std::uint32_t kSmallest = kAllFlags & ~std::uint32_t{kResiduals};

  /// When the surface is fitted anew.
  enum class Refit : std::uint8_t { PerCell, PerPoint, Always };

  static constexpr std::uint8_t kMostNearPoints = 24;
  /// What the encoder tries beside the effort's number of points a cell.
  static constexpr std::uint8_t kLargeCellPoints = 12;

  std::uint32_t flags = kSmallest;
  std::uint8_t cellPoints = 6;   ///< cells of so many points or fewer are coded depth first
  std::uint8_t nearPoints = 16;  ///< so many known points make candidates at first
  std::uint8_t pairReach = 16;   ///< pairs of them make candidates up to that distance: its square
  Refit refit = Refit::Always;
  /// Boxes of one point up to so many eighths of a width of candidates are flat (FlatBoxes); with
  /// 0 none is.
  std::uint8_t flatShare = 0;

  bool has(Flag flag) const { return (flags & flag) != 0; }
};

}  // namespace bspc::geometry::predictive
