#include "support/point_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace bspc::test {

namespace {

constexpr std::uint32_t kTop = std::numeric_limits<std::uint32_t>::max();

std::vector<GridPoint> corners(std::uint32_t low, std::uint32_t high) {
  std::vector<GridPoint> points;
  for (unsigned i = 0; i < 8; ++i) {
    points.push_back(
        {(i & 1) != 0 ? high : low, (i & 2) != 0 ? high : low, (i & 4) != 0 ? high : low});
  }
  return points;
}

std::vector<GridPoint> manyEqualClusters(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<GridPoint> points;
  for (unsigned cluster = 0; cluster < 20; ++cluster) {
    const auto at = [&random] { return static_cast<std::uint32_t>(random() % 1000); };
    const GridPoint p{at(), at(), at()};
    points.insert(points.end(), 1 + random() % 400, p);
  }
  return points;
}

}  // namespace

std::vector<GridPoint> randomPoints(std::uint64_t seed, std::size_t count,
                                    const GridPoint& extent) {
  std::mt19937_64 random(seed);
  std::vector<GridPoint> points(count);
  for (GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<std::uint32_t>(random() % (std::uint64_t{extent[k]} + 1));
    }
  }
  return points;
}

std::vector<GridPoint> scannedSphere(std::uint64_t seed, std::size_t count,
                                     std::uint32_t diameter) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<GridPoint> points(count);
  for (GridPoint& p : points) {
    const double z = 2 * uniform() - 1;
    const double angle = 6.283185307179586 * uniform();
    const double ring = std::sqrt(1 - z * z);
    const double radius = 0.45 + 0.04 * std::sin(5 * angle) * ring + 0.002 * uniform();
    const double direction[3] = {ring * std::cos(angle), ring * std::sin(angle), z};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<std::uint32_t>((0.5 + radius * direction[k]) * diameter);
    }
  }
  return points;
}

std::vector<NamedPoints> degenerateSets() {
  std::vector<NamedPoints> sets;
  sets.push_back({"one at the origin", {{0, 0, 0}}});
  sets.push_back({"one at the far corner", {{kTop, kTop, kTop}}});
  sets.push_back({"two neighbours", {{0, 0, 0}, {1, 0, 0}}});
  sets.push_back({"two at opposite corners", {{0, 0, 0}, {kTop, kTop, kTop}}});
  sets.push_back({"corners of the full range", corners(0, kTop)});
  sets.push_back({"corners just below a power of two", corners(0, 1023)});
  sets.push_back({"corners just above a power of two", corners(0, 1024)});
  sets.push_back({"all equal", std::vector<GridPoint>(5000, GridPoint{7, 8, 9})});
  sets.push_back({"clusters of equal points", manyEqualClusters(3)});
  sets.push_back({"random, full range", randomPoints(1, 500, {kTop, kTop, kTop})});
  sets.push_back({"random, crowded", randomPoints(2, 5000, {15, 15, 15})});
  sets.push_back({"random, odd box", randomPoints(4, 3000, {1000, 3, 70000})});
  sets.push_back({"random line", randomPoints(5, 2000, {100000, 0, 0})});
  sets.push_back({"random plane", randomPoints(6, 2000, {0, 5000, 5000})});
  std::vector<GridPoint> diagonal;
  for (std::uint32_t i = 0; i < 1500; ++i) diagonal.push_back({i, i, i});
  sets.push_back({"diagonal", diagonal});
  std::vector<GridPoint> full;
  for (std::uint32_t i = 0; i < 4096; ++i) full.push_back({i & 15, (i >> 4) & 15, i >> 8});
  sets.push_back({"every position of a cube", full});
  sets.push_back({"bumpy sphere", scannedSphere(7, 20000, 4095)});
  sets.push_back({"bumpy sphere, fine grid", scannedSphere(8, 6000, 1U << 31)});
  return sets;
}

std::vector<GridPoint> sorted(std::vector<GridPoint> points) {
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace bspc::test
