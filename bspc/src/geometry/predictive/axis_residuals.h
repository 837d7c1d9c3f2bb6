#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "geometry/predictive/candidates.h"
#include "geometry/predictive/question.h"
#include "geometry/predictive/surface.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Predictor: where the only point of a box lies, one axis after the other rather than half by
/// half of the whole box. Along the axes that lie most in the surface it follows the candidates;
/// across it, the surface or the candidates, whichever are surer. All bits of an axis follow from
/// one place and one scale, so that a bit costs a fraction of a whole decision.
class AxisResiduals {
 public:
  /// What speaks: the candidates, along the first, second or last axis, or the surface.
  enum Kind : unsigned { kFirstAxis, kSecondAxis, kLastAxis, kSurface, kKinds };

  /// The coordinate is spread around `place`, in grid steps from the cell's corner, by `scale`.
  struct Expected {
    float place = 0;
    float scale = 1;
    unsigned kind = kFirstAxis;
  };

  /// Before the first axis. The candidates have been weighed in the box.
  void start(const Question& box, const Surface& surface) {
    orderAxes(surface);
    for (unsigned k = 0; k < 3; ++k) {
      at_[k] = box.centre(k);
      variance_[k] = box.size[k] * box.size[k] * (1.0F / 12);
    }
    if (!surface.quadric.valid) return;
    const Quadric& s = surface.quadric;
    const float height =
        entropy::clamped(s.heightAt(at_[0], at_[1], at_[2]), -0.5F, 0.5F) / s.inverseSpacing;
    for (unsigned k = 0; k < 3; ++k) at_[k] -= height * s.normal[k];
  }

  /// The axes in their order: those across the surface come last.
  unsigned axis(unsigned rank) const { return order_[rank]; }

  /// Along the axis of that rank. `surfaceError` in spacings.
  Expected expected(unsigned rank, const Surface& surface, const Candidates& candidates,
                    float surfaceError) const {
    const unsigned k = order_[rank];
    const Candidates::Moments m = candidates.momentsAlong(k, at_[k]);
    const float variance = m.variance + m.unexplained * variance_[k];
    Expected e;
    e.kind = rank;
    e.place = at_[k] + m.mean;
    e.scale = std::sqrt((variance > 0 ? variance : 0) + candidates.kernelVariance());
    if (rank == 2 && surface.quadric.valid) preferSurface(e, k, surface.quadric, surfaceError);
    return e;
  }

  /// The point has been found along an axis.
  void found(unsigned axis, float place) { at_[axis] = place; }

 private:
  void orderAxes(const Surface& surface) {
    Vector3 slope{};
    if (surface.quadric.valid || surface.plane.valid) {
      const Vector3& normal = surface.quadric.valid ? surface.quadric.normal : surface.plane.normal;
      for (unsigned k = 0; k < 3; ++k) slope[k] = entropy::magnitude(normal[k]);
    }
    order_ = {0, 1, 2};
    const auto sort = [&](unsigned i, unsigned j) {
      if (slope[order_[i]] > slope[order_[j]]) std::swap(order_[i], order_[j]);
    };
    sort(0, 1);
    sort(1, 2);
    sort(0, 1);
  }

  /// Where the surface cuts the axis, if that is surer.
  void preferSurface(Expected& e, unsigned k, const Quadric& s, float surfaceError) const {
    constexpr float kSteep = 0.4F;
    Vector3 place = at_;
    place[k] = e.place;
    const Quadric::Value value = s.at(place[0], place[1], place[2]);
    const float slope = entropy::magnitude(value.gradient[k]);
    if (!(slope > kSteep)) return;
    const float scale = surfaceError / (slope * s.inverseSpacing) + 0.3F;
    if (!(scale < e.scale)) return;
    e.kind = kSurface;
    e.place -= entropy::clamped(value.height / value.gradient[k], -1, 1) / s.inverseSpacing;
    e.scale = scale;
  }

  std::array<unsigned, 3> order_{};
  Vector3 at_{};        ///< what is expected or known of the place, in grid steps
  Vector3 variance_{};  ///< of places anywhere in the box
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
