#pragma once

#include <cstdint>

#include "bspc/error.h"
#include "entropy/symbol_coder.h"
#include "geometry/predictive/efforts.h"
#include "geometry/predictive/features.h"

namespace bspc::geometry::predictive {

/// What stands in the place of an effort where the features stand one by one.
constexpr unsigned kOwnFeatures = 15;

/// Codes what a tile is coded with, in front of its first layer: the number of an effort, or
/// kOwnFeatures and the features one by one.
template <class Coder>
void codeFeatures(Coder& coder, unsigned effort, Features& features) {
  effort = coder.raw(effort, 4);
  if (effort >= kLeastEffort && effort <= kMostEffort) {
    features = featuresOf(effort);
    return;
  }
  if (effort != kOwnFeatures) {
    throw Error(ErrorCode::Corrupt, "a tile of method predictive names an effort of " +
                                        std::to_string(effort) + ", which does not exist");
  }
  const auto byte = [&coder](std::uint8_t value) {
    return static_cast<std::uint8_t>(coder.raw(value, 8));
  };
  features.flags = static_cast<std::uint32_t>(coder.wide(features.flags, 32));
  features.cellPoints = byte(features.cellPoints);
  features.nearPoints = byte(features.nearPoints);
  features.pairReach = byte(features.pairReach);
  features.refit = static_cast<Features::Refit>(byte(static_cast<std::uint8_t>(features.refit)));
  features.flatShare = byte(features.flatShare);
  if ((features.flags & ~Features::kAllFlags) != 0 || features.cellPoints == 0 ||
      features.nearPoints == 0 || features.nearPoints > Features::kMostNearPoints ||
      features.refit > Features::Refit::Always) {
    throw Error(ErrorCode::Corrupt,
                "a tile of method predictive has features that this version does not know");
  }
}

}  // namespace bspc::geometry::predictive
