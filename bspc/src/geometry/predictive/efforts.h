#pragma once

#include "geometry/predictive/features.h"

namespace bspc::geometry::predictive {

constexpr unsigned kLeastEffort = 5;
constexpr unsigned kMostEffort = 9;

/// The features of an effort, kLeastEffort … kMostEffort. They are part of the format: a tile's
/// header may name them by the effort (docs/format.md, "Method predictive").
Features featuresOf(unsigned effort);

}  // namespace bspc::geometry::predictive
