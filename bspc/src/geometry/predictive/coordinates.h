#pragma once

#include <algorithm>
#include <array>

#include "entropy/logistic_math.h"
#include "geometry/predictive/near_points.h"
#include "geometry/predictive/question.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Predictor: coordinates of near points tend to come again, and points keep a distance.
class Coordinates {
 public:
  float narrow = 0;
  float wide = 0;
  unsigned lowerDistance = 0;  ///< class of the distance of the half's middle to the nearest point
  unsigned upperDistance = 0;
  static constexpr unsigned kDistanceClasses = 15;

  /// When the box is not the half of the one asked about last, or a point was found.
  void startBox() { kernels_ = {}; }

  void ask(const Question& q, const NearPoints& near, float spacing, bool wantWide,
           bool wantDistances);

  /// The box is halved: only one half of the last question's is left.
  void take(unsigned axis, bool upper) {
    for (unsigned k = 0; k < kernels_[axis]; ++k) {
      Kernel& kernel = kernel_[k];
      float* face = upper ? kernel.low[axis] : kernel.high[axis];
      for (unsigned i = 0; i < lanes_; i += entropy::kLanes) {
        entropy::store(face + i, entropy::load(kernel.at + i));
      }
    }
  }
  /// Nothing was asked before the box was halved across the axis.
  void forget(unsigned axis) { kernels_[axis] = 0; }

 private:
  /// Distribution functions around the near points' coordinates, by axis.
  struct Kernel {
    float scale = 1;
    alignas(32) float low[3][NearPoints::kMost]{};   ///< at the lower face of the box
    alignas(32) float high[3][NearPoints::kMost]{};  ///< and at the upper one
    alignas(32) float at[NearPoints::kMost]{};       ///< at the middle of the last question

    void start(unsigned axis, unsigned i, const entropy::Lanes& toLow,
               const entropy::Lanes& toHigh) {
      entropy::store(low[axis] + i, entropy::bell(toLow * scale));
      entropy::store(high[axis] + i, entropy::bell(toHigh * scale));
    }
  };
  /// Masses in the halves.
  struct Sums {
    entropy::Lanes lower = {};
    entropy::Lanes upper = {};
    BSPC_LANES_INLINE void add(Kernel& kernel, unsigned axis, unsigned i,
                               const entropy::Lanes& toMiddle) {
      const entropy::Lanes at = entropy::bell(toMiddle * kernel.scale);
      entropy::store(kernel.at + i, at);
      lower += at - entropy::load(kernel.low[axis] + i);
      upper += entropy::load(kernel.high[axis] + i) - at;
    }
    float evidence() const {
      return entropy::naturalLog((entropy::sum(upper) + 0.02F) / (entropy::sum(lower) + 0.02F));
    }
  };

  void startAxis(const Question& q, const NearPoints& near, float spacing);
  void measure(const Question& q, const NearPoints& near, float spacing);

  std::array<unsigned, 3> kernels_{};  ///< so many have their values at the faces, by axis
  unsigned lanes_ = 0;                 ///< of the near points
  std::array<Kernel, 2> kernel_{};
};

/// Class of a square distance in square spacings.
inline unsigned distanceClass(float square) {
  return static_cast<unsigned>(std::clamp(entropy::halfOctave(square + 1e-6F), -9, 5) + 9);
}

inline void Coordinates::ask(const Question& q, const NearPoints& near, float spacing,
                             bool wantWide, bool wantDistances) {
  const unsigned wanted = wantWide ? 2 : 1;
  if (kernels_[q.axis] < wanted) startAxis(q, near, spacing);
  kernels_[q.axis] = wanted;
  const float* along = near.along(q.axis);
  Sums narrowSums;
  Sums wideSums;
  for (unsigned i = 0; i < lanes_; i += entropy::kLanes) {
    const entropy::Lanes toMiddle = q.middle - entropy::load(along + i);
    narrowSums.add(kernel_[0], q.axis, i, toMiddle);
    if (wantWide) wideSums.add(kernel_[1], q.axis, i, toMiddle);
  }
  narrow = narrowSums.evidence();
  wide = wantWide ? wideSums.evidence() : 0;
  lowerDistance = upperDistance = 0;
  if (wantDistances) measure(q, near, spacing);
}

inline void Coordinates::startAxis(const Question& q, const NearPoints& near, float spacing) {
  lanes_ = static_cast<unsigned>(entropy::wholeLanes(near.count));
  kernel_[0].scale = 1.6F;
  kernel_[1].scale = 1 / (0.1F * spacing + 0.6F);
  const float* along = near.along(q.axis);
  const float low = q.lower[q.axis];
  const float high = low + q.size[q.axis];
  for (unsigned i = 0; i < lanes_; i += entropy::kLanes) {
    const entropy::Lanes place = entropy::load(along + i);
    for (Kernel& kernel : kernel_) kernel.start(q.axis, i, low - place, high - place);
  }
}

/// Distances of the halves' middles to the nearest point.
inline void Coordinates::measure(const Question& q, const NearPoints& near, float spacing) {
  using entropy::Lanes;
  const float quarter = 0.25F * q.size[q.axis];
  Lanes toLower = entropy::Lanes(1e36F);
  Lanes toUpper = toLower;
  for (unsigned i = 0; i < entropy::wholeLanes(near.count); i += entropy::kLanes) {
    const Lanes dx = entropy::load(near.x + i) - q.centre(0);
    const Lanes dy = entropy::load(near.y + i) - q.centre(1);
    const Lanes dz = entropy::load(near.z + i) - q.centre(2);
    const Lanes d = q.axis == 0 ? dx : q.axis == 1 ? dy : dz;
    const Lanes rest = (dx * dx + dy * dy + dz * dz) - d * d;
    toLower = entropy::smaller(toLower, rest + (d + quarter) * (d + quarter));
    toUpper = entropy::smaller(toUpper, rest + (d - quarter) * (d - quarter));
  }
  const float unit2 = 1 / (spacing * spacing);
  lowerDistance = distanceClass(entropy::least(toLower) * unit2);
  upperDistance = distanceClass(entropy::least(toUpper) * unit2);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
