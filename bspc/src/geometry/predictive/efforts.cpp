#include "geometry/predictive/efforts.h"

namespace bspc::geometry::predictive {

Features featuresOf(unsigned effort) {
  (void)effort;
  return {};
}

}  // namespace bspc::geometry::predictive
