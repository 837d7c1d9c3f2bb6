#pragma once

#include "bspc/limits.h"

namespace bspc::fuzz {

/// What a decoding may cost here: little, so that many inputs can be tried, and so that whoever
/// goes beyond it is caught by the limits that fuzzers are run with.
inline DecodeLimits smallLimits() {
  DecodeLimits limits;
  limits.points = 1500;
  limits.memoryBytes = std::uint64_t{64} << 20;
  limits.tiles = 1024;
  limits.arrays = 64;
  return limits;
}

}  // namespace bspc::fuzz
