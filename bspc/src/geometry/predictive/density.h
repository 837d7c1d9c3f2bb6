#pragma once

#include <algorithm>

#include "entropy/logistic_math.h"
#include "geometry/predictive/coordinates.h"
#include "geometry/predictive/neighbourhood.h"
#include "geometry/predictive/question.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Predictor: where more points are around, more are to come.
class Density {
 public:
  float evidence = 0;
  unsigned lowerDistance = 0;  ///< as in Coordinates, to points and cells alike
  unsigned upperDistance = 0;

  /// `most`: how many entries of the neighbourhood count.
  void ask(const Question& q, const Neighbourhood& near, float spacing, unsigned most) {
    using entropy::Lanes;
    const float scale = 1 / (q.size[0] * q.size[0] + 0.3F * spacing * spacing);
    const float quarter = 0.25F * q.size[q.axis];
    Lanes lower = {};
    Lanes upper = {};
    Lanes toLower = entropy::Lanes(1e36F);
    Lanes toUpper = toLower;
    const auto whole = entropy::wholeLanes(near.count);
    const unsigned count = std::min(whole, most);
    for (unsigned i = 0; i < count; i += entropy::kLanes) {
      const Lanes dx = entropy::load(near.x + i) - q.centre(0);
      const Lanes dy = entropy::load(near.y + i) - q.centre(1);
      const Lanes dz = entropy::load(near.z + i) - q.centre(2);
      const Lanes d = q.axis == 0 ? dx : q.axis == 1 ? dy : dz;
      const Lanes rest = (dx * dx + dy * dy + dz * dz) - d * d;
      const Lanes square1 = rest + (d + quarter) * (d + quarter);
      const Lanes square2 = rest + (d - quarter) * (d - quarter);
      const Lanes weight = entropy::load(near.weight + i);
      const Lanes t1 = 1.0F / (1.0F + square1 * scale);
      const Lanes t2 = 1.0F / (1.0F + square2 * scale);
      lower += weight * t1 * t1;
      upper += weight * t2 * t2;
      toLower = entropy::smaller(toLower, square1);
      toUpper = entropy::smaller(toUpper, square2);
    }
    evidence = entropy::naturalLog((entropy::sum(upper) + 1e-4F) / (entropy::sum(lower) + 1e-4F));
    const float unit2 = 1 / (spacing * spacing);
    lowerDistance = distanceClass(entropy::least(toLower) * unit2);
    upperDistance = distanceClass(entropy::least(toUpper) * unit2);
  }
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
