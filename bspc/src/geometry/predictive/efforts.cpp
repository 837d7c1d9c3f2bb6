#include "geometry/predictive/efforts.h"

namespace bspc::geometry::predictive {

namespace {

constexpr std::uint32_t kLeast = Features::kQuadric | Features::kParallelograms |
                                 Features::kAxisValues | Features::kPhase | Features::kMirror |
                                 Features::kRangeImage;
constexpr std::uint32_t kLean = kLeast | Features::kProjection;
constexpr std::uint32_t kMiddle =
    kLean | Features::kSeparateKinds | Features::kNearest | Features::kManyContexts;
// Efforts 8 and 9 have all flags but the residuals.

}  // namespace

Features featuresOf(unsigned effort) {
  Features f;
  switch (effort) {
    case 5:
      f.flags = kLeast | Features::kResiduals;
      f.nearPoints = 6;
      f.pairReach = 8;
      f.refit = Features::Refit::PerCell;
      break;
    case 6:
      f.flags = kLean;
      f.flatShare = 6;
      f.nearPoints = 10;
      f.pairReach = 9;
      f.refit = Features::Refit::PerPoint;
      break;
    case 7:
      f.flags = kMiddle;
      f.flatShare = 4;
      f.nearPoints = 13;
      f.pairReach = 14;
      f.refit = Features::Refit::PerPoint;
      break;
    case 8:
      f.flatShare = 2;
      f.nearPoints = 16;
      f.pairReach = 36;
      f.refit = Features::Refit::PerPoint;
      break;
    default:
      f.nearPoints = 20;
      f.pairReach = 64;
      f.refit = Features::Refit::Always;
  }
  return f;
}

}  // namespace bspc::geometry::predictive
