#pragma once

#include <algorithm>
#include <array>

#include "entropy/logistic_math.h"
#include "geometry/predictive/candidates.h"
#include "geometry/predictive/question.h"
#include "geometry/predictive/surface.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Which boxes of one point are flat: so small against what candidates and surface are wrong by
/// that both say nearly the same of all places in them. What they would say of the halves follows
/// from what they said of a larger box, in proportion to its side, and need not be worked out
/// again: the lower bits of deep grids cost a fraction of the upper ones.
class FlatBoxes {
 public:
  static constexpr float kUnit = 0.125F;  ///< of a width; features say how many

  /// Before the first question about a box. `share`: how many kUnit of a width a flat box may be
  /// large; `spacing` in grid steps, the errors in spacings.
  void start(float share, float spacing, float candidateError, float surfaceError,
             const Plane& plane) {
    const float width = 0.6F * candidateError * spacing;
    const float depth = surfaceError * spacing;
    for (unsigned k = 0; k < 3; ++k) {
      const float along = plane.valid ? entropy::magnitude(plane.normal[k]) : 0;
      largest_[k] = kUnit * share * std::min(width, depth / (along + 0.001F));
      perStep_[k] = {};
    }
  }

  bool isFlat(const Question& q) const { return q.size[q.axis] <= largest_[q.axis]; }

  /// What was said of the halves of the question's box.
  void remember(const Question& q, float surface, const Candidates& candidates) {
    auto& said = perStep_[q.axis];
    const float unit = 1 / q.size[q.axis];
    said[0] = surface * unit;
    for (unsigned kind = 0; kind < Candidates::kKinds; ++kind) {
      if (!candidates.speaks(kind)) continue;
      said[1 + kind] = candidates.answer[kind][0].evidence * unit;
    }
  }

  /// What they would say of the halves of this one.
  float surfaceEvidence(const Question& q) const { return perStep_[q.axis][0] * q.size[q.axis]; }
  float candidateEvidence(const Question& q, unsigned kind) const {
    return perStep_[q.axis][1 + kind] * q.size[q.axis];
  }

 private:
  std::array<float, 3> largest_{};  ///< sides of flat boxes, in grid steps
  /// Evidence of the surface, then of each kind of candidates.
  std::array<std::array<float, 1 + Candidates::kKinds>, 3> perStep_{};
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
