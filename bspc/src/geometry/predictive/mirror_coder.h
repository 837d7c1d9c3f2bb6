#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/lanes.h"
#include "entropy/symbol_coder.h"
#include "geometry/predictive/mirror_plane.h"
#include "geometry/predictive/phase_lattice.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Codes the copies of points that a plane mirrors: for each original, in the order that they were
/// decoded in, whether it has a copy, and how far that lies beside the exact image.
///
/// Coder is SymbolWriter or SymbolReader.
template <class Coder>
class MirrorCoder {
 public:
  MirrorCoder(const MirrorPlane& plane, const GridPoint& extent) : plane_(plane), extent_(extent) {
    for (auto& memory : lastSteps_) memory.assign(kRemembered, 0);
  }

  /// Codes the copy of `original`, a point with plane.isOriginal(). A writer says in `offset`
  /// whether there is one and where. Throws Error(Corrupt) where that lies outside of the tile.
  std::optional<GridPoint> code(Coder& coder, const GridPoint& original,
                                const std::optional<MirrorOffset>& offset,
                                const PhaseHistograms& phases) {
    const std::uint64_t apart = plane_.sum - 2 * std::uint64_t{original[plane_.axis]};
    const unsigned again = seen_ && last_ == original ? 1 : 0;
    Bit& exists = exists_[std::min<std::uint64_t>(apart, kApart - 1)][lastExisted_ ? 1 : 0][again];
    last_ = original;
    seen_ = true;
    lastExisted_ = coder.bit(exists, offset.has_value());
    if (!lastExisted_) return std::nullopt;
    GridPoint copy = original;
    unsigned moved = 0;
    const std::array<unsigned, 3> axes = plane_.axes();
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned axis = axes[k];
      const std::uint64_t image = k == 0 ? plane_.sum - original[axis] : original[axis];
      std::uint8_t& before = lastSteps_[k][original[axis] % kRemembered];
      Models& models = steps_[k][likelyStep(image, phases[axis])][before][std::min(moved, 2U)];
      const int step = codeStep(coder, offset ? (*offset)[k] : 0, models);
      before = static_cast<std::uint8_t>(2 + step);
      if (step != 0) ++moved;
      const auto value = static_cast<std::int64_t>(image) + step;
      if (value < 0 || value > std::int64_t{extent_[axis]}) {
        throw Error(ErrorCode::Corrupt,
                    "a mirrored point lies outside of its tile: the file is damaged");
      }
      copy[axis] = static_cast<std::uint32_t>(value);
    }
    return copy;
  }

 private:
  using Bit = entropy::AdaptiveBit;
  static constexpr unsigned kApart = 4;
  static constexpr unsigned kLikely = 4;
  /// Steps come from rounding, so equal coordinates mostly took the same one: 0 for "none yet",
  /// then 2 plus the step. Coordinates that far apart share a place.
  static constexpr std::uint32_t kRemembered = 1U << 16;
  static constexpr unsigned kBefore = 4;

  /// 1, 2, 3 if the phase of the image, of the value below or of that above is the likeliest;
  /// 0 if nothing is known of phases.
  static unsigned likelyStep(std::uint64_t image, const PhaseHistogram& phases) {
    if (!phases.isActive()) return 0;
    const auto at = static_cast<std::uint32_t>(image);
    const std::uint32_t here = phases.weight(at);
    const std::uint32_t below = phases.weight(at - 1);
    const std::uint32_t above = phases.weight(at + 1);
    if (here >= below && here >= above) return 1;
    return below >= above ? 2 : 3;
  }

  struct Models {
    Bit moves;
    Bit up;
  };

  static int codeStep(Coder& coder, int step, Models& models) {
    if (!coder.bit(models.moves, step != 0)) return 0;
    return coder.bit(models.up, step > 0) ? 1 : -1;
  }

  MirrorPlane plane_;
  GridPoint extent_;
  GridPoint last_{};
  bool seen_ = false;
  bool lastExisted_ = true;
  std::array<std::array<std::array<Bit, 2>, 2>, kApart> exists_;
  std::array<std::vector<std::uint8_t>, 3> lastSteps_;  ///< by coordinate of the original
  std::array<std::array<std::array<std::array<Models, 3>, kBefore>, kLikely>, 3> steps_;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
