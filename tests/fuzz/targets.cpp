#include "target.h"

namespace bspc::fuzz {

std::vector<Target> targets() {
  return {decodeTarget(), queryTarget(), roundTripTarget(), modelTarget()};
}

}  // namespace bspc::fuzz
