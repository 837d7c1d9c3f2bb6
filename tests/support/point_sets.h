#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/grid.h"

namespace bspc::test {

struct NamedPoints {
  std::string name;
  std::vector<GridPoint> points;
};

/// Small grid point sets that have broken point coders before: one point, equal points, lines,
/// planes, corners of the full 32-bit range, clusters, duplicates, and plain random ones.
std::vector<NamedPoints> degenerateSets();

/// `count` points on a bumpy sphere of that diameter in grid steps: like a scan.
std::vector<GridPoint> scannedSphere(std::uint64_t seed, std::size_t count, std::uint32_t diameter);

/// `count` uniformly random points, each coordinate in 0 … extent.
std::vector<GridPoint> randomPoints(std::uint64_t seed, std::size_t count, const GridPoint& extent);

std::vector<GridPoint> sorted(std::vector<GridPoint> points);

}  // namespace bspc::test
