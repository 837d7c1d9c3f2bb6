#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "entropy/lanes.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// A place that is decoded, and how well it had been predicted: what is to be expected around it.
struct KnownPoint {
  /// Stands for "no other point was seen yet".
  static constexpr float kFar = 1e10F;

  GridPoint position{};
  float nearest = kFar;      ///< distance to the nearest other one seen so far
  float surfaceError = 0;    ///< distance to the fitted surface, in spacings
  float candidateError = 0;  ///< distance to the nearest candidate, in spacings, at most 1/2
};

using KnownPoints = std::vector<KnownPoint>;

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
