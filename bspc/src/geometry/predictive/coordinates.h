#pragma once

#include <algorithm>

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

  void ask(const Question& q, const NearPoints& near, float spacing, bool wantWide,
           bool wantDistances);

 private:
  struct Sums {
    entropy::Lanes lower = {};
    entropy::Lanes upper = {};
    float evidence() const {
      return entropy::naturalLog((entropy::sum(upper) + 0.02F) / (entropy::sum(lower) + 0.02F));
    }
  };
};

/// Class of a square distance in square spacings.
inline unsigned distanceClass(float square) {
  return static_cast<unsigned>(std::clamp(entropy::halfOctave(square + 1e-6F), -9, 5) + 9);
}

inline void Coordinates::ask(const Question& q, const NearPoints& near, float spacing,
                             bool wantWide, bool wantDistances) {
  using entropy::Lanes;
  constexpr float kNarrow = 1.6F;
  const float wideScale = 1 / (0.1F * spacing + 0.6F);
  const float* along = near.along(q.axis);
  const float low = q.lower[q.axis];
  const float high = low + q.size[q.axis];
  const float quarter = 0.25F * q.size[q.axis];
  Sums narrowSums;
  Sums wideSums;
  Lanes toLower = entropy::Lanes(1e36F);
  Lanes toUpper = toLower;
  for (unsigned i = 0; i < entropy::wholeLanes(near.count); i += entropy::kLanes) {
    const Lanes place = entropy::load(along + i);
    const Lanes toMiddle = q.middle - place;
    const Lanes toLow = low - place;
    const Lanes toHigh = high - place;
    const Lanes at = entropy::bell(toMiddle * kNarrow);
    narrowSums.lower += at - entropy::bell(toLow * kNarrow);
    narrowSums.upper += entropy::bell(toHigh * kNarrow) - at;
    if (wantWide) {
      const Lanes wideAt = entropy::bell(toMiddle * wideScale);
      wideSums.lower += wideAt - entropy::bell(toLow * wideScale);
      wideSums.upper += entropy::bell(toHigh * wideScale) - wideAt;
    }
    if (wantDistances) {
      const Lanes dx = entropy::load(near.x + i) - q.centre(0);
      const Lanes dy = entropy::load(near.y + i) - q.centre(1);
      const Lanes dz = entropy::load(near.z + i) - q.centre(2);
      const Lanes d = q.axis == 0 ? dx : q.axis == 1 ? dy : dz;
      const Lanes rest = (dx * dx + dy * dy + dz * dz) - d * d;
      toLower = entropy::smaller(toLower, rest + (d + quarter) * (d + quarter));
      toUpper = entropy::smaller(toUpper, rest + (d - quarter) * (d - quarter));
    }
  }
  narrow = narrowSums.evidence();
  wide = wantWide ? wideSums.evidence() : 0;
  const float unit2 = 1 / (spacing * spacing);
  lowerDistance = wantDistances ? distanceClass(entropy::least(toLower) * unit2) : 0;
  upperDistance = wantDistances ? distanceClass(entropy::least(toUpper) * unit2) : 0;
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
