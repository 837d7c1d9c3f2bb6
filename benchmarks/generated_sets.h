#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark_support.h"

namespace bspc::bench {

/// What generatedPoints() knows: "surface" (a bumpy ball, scanned from around it), "lines" (terrain
/// with trees in the scan lines of an aircraft, centimetres), "depth" (frames of a depth camera,
/// millimetres), "cad" (a mirror-symmetric machine part), "random" (uniform in a cube).
std::vector<std::string> generatedKinds();

/// About `count` points on an integer grid, in the order in which such data come; the distance of
/// neighbours does not depend on the count, but with "cad" and in one frame of "depth". A function
/// of its arguments. Throws std::invalid_argument for other kinds.
Coordinates generatedPoints(const std::string& kind, std::uint64_t count);

}  // namespace bspc::bench
