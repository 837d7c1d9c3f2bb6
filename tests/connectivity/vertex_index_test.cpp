#include "connectivity/vertex_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/point_sets.h"

namespace bspc::connectivity {
namespace {

std::vector<Position> positionsOf(const std::vector<GridPoint>& points) {
  std::vector<Position> positions;
  positions.reserve(points.size());
  for (const GridPoint& p : points) {
    positions.push_back({double(p[0]), double(p[1]), double(p[2])});
  }
  return positions;
}

std::vector<std::uint32_t> byBruteForce(const std::vector<Position>& positions,
                                        const std::vector<bool>& awake, const Position& place,
                                        std::size_t count) {
  std::vector<std::pair<double, std::uint32_t>> all;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (!awake[i]) continue;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = 2 * positions[i][k] - place[k];
      sum += d * d;
    }
    all.emplace_back(sum, i);
  }
  std::sort(all.begin(), all.end());
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < std::min(count, all.size()); ++i) result.push_back(all[i].second);
  return result;
}

std::vector<std::uint32_t> numbersOf(const std::vector<Neighbour>& neighbours) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(neighbours.size());
  for (const Neighbour& n : neighbours) numbers.push_back(n.vertex);
  return numbers;
}

TEST(VertexIndex, FindsTheNearestOfThoseAwake) {
  std::mt19937_64 random(3);
  for (const test::NamedPoints& set : test::degenerateSets()) {
    const std::vector<Position> positions = positionsOf(set.points);
    VertexIndex index(positions);
    std::vector<bool> awake(positions.size(), true);
    std::vector<Neighbour> found;
    for (int i = 0; i < 25 && !positions.empty(); ++i) {
      const auto vertex = static_cast<std::uint32_t>(random() % positions.size());
      awake[vertex] = random() % 4 == 0;
      if (awake[vertex]) {
        index.wake(vertex);
      } else {
        index.putToSleep(vertex);
      }
      Position place = positions[random() % positions.size()];
      for (double& x : place) x = 2 * x + static_cast<double>(random() % 7);
      index.nearest(place, 6, VertexIndex::Among::Awake, found);
      ASSERT_EQ(numbersOf(found), byBruteForce(positions, awake, place, 6)) << set.name;
      index.nearest(place, 6, VertexIndex::Among::All, found);
      ASSERT_EQ(numbersOf(found),
                byBruteForce(positions, std::vector<bool>(positions.size(), true), place, 6))
          << set.name;
    }
  }
}

TEST(VertexIndex, OfNothingFindsNothing) {
  const VertexIndex index{Span<const Position>()};
  std::vector<Neighbour> found(3);
  index.nearest({}, 5, VertexIndex::Among::All, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace bspc::connectivity
