#include "attributes/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "attributes/logistic_mixer.h"
#include "attributes/octahedral_map.h"
#include "attributes/ordered_words.h"
#include "attributes/prediction_weights.h"
#include "attributes/window_table.h"
#include "support/point_sets.h"

namespace bspc::attributes {
namespace {

TEST(Neighbours, AreEarlierAndNearestFirst) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    for (const std::size_t known : {std::size_t{0}, set.points.size() / 3}) {
      const RankedPoints ranked = rankPoints(set.points, known);
      const NeighbourTable table(ranked, 8, 3);
      for (std::size_t rank = known; rank < ranked.size(); ++rank) {
        const Span<const std::uint32_t> near = table.of(rank);
        ASSERT_EQ(near.empty(), rank == 0) << set.name;
        for (std::size_t j = 0; j < near.size(); ++j) {
          ASSERT_LT(near[j], rank);
          ASSERT_EQ(std::count(near.begin(), near.end(), near[j]), 1);
        }
      }
    }
  }
}

TEST(Neighbours, AreTheNearestOfAllWhereTheSearchReaches) {
  const std::vector<GridPoint> points = test::scannedSphere(41, 1500, 300);
  const RankedPoints ranked = rankPoints(points, 500);
  const NeighbourTable table(ranked, 3, 3);
  std::size_t exact = 0;
  for (std::uint32_t rank = 500; rank < ranked.size(); ++rank) {
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t other = 0; other < rank; ++other) {
      least = std::min(least, ranked.squaredDistance(rank, other));
    }
    if (ranked.squaredDistance(rank, table.of(rank)[0]) == least) ++exact;
  }
  EXPECT_GT(exact, 950U) << "of 1000";
}

TEST(Neighbours, KnownPointsHaveTheLowestRanks) {
  const std::vector<GridPoint> points = test::scannedSphere(42, 300, 3000);
  const RankedPoints ranked = rankPoints(points, 100);
  for (std::size_t rank = 0; rank < ranked.size(); ++rank) {
    EXPECT_EQ(ranked.indexOfRank[rank] < 100, rank < 100);
  }
}

TEST(PredictionWeights, FunctionsOfTheirDegreeAreReproduced) {
  const std::vector<GridPoint> points = test::randomPoints(43, 2000, {500, 500, 500});
  const RankedPoints ranked = rankPoints(points, 0);
  const NeighbourTable wide(ranked, 20, 6);
  const auto linear = [&ranked](std::uint32_t r) {
    const auto& p = ranked.positions[r];
    return 3.0 * p[0] - 2.0 * p[1] + 0.5 * p[2] + 7;
  };
  const auto quadratic = [&ranked, &linear](std::uint32_t r) {
    const auto& p = ranked.positions[r];
    return linear(r) + 0.01 * p[0] * p[1] - 0.02 * p[2] * p[2];
  };
  for (const Predictor predictor : {Predictor::PlaneOver8, Predictor::QuadricOver20}) {
    const PredictionWeights weights(ranked, predictor, 3);
    WeightedNeighbours near;
    double miss = 0;
    for (std::uint32_t rank = 1500; rank < ranked.size(); ++rank) {
      weights.find(rank, wide.of(rank), near);
      double sum = 0;
      const bool isPlane = predictor == Predictor::PlaneOver8;
      for (std::size_t j = 0; j < near.ranks.size(); ++j) {
        sum += near.weights[j] * (isPlane ? linear(near.ranks[j]) : quadratic(near.ranks[j]));
      }
      miss += std::abs(sum - (isPlane ? linear(rank) : quadratic(rank)));
    }
    EXPECT_LT(miss / 500, 3.0) << "of values of up to 1750";
  }
}

TEST(WindowTable, NamesTheNearestOfTheLastSixteen) {
  const std::vector<GridPoint> points = test::randomPoints(44, 200, {90, 90, 90});
  const WindowTable window(points);
  const auto distance = [&points](std::size_t a, std::size_t b) {
    std::int64_t sum = 0;
    for (unsigned k = 0; k < 3; ++k) {
      sum += std::abs(std::int64_t{points[a][k]} - std::int64_t{points[b][k]});
    }
    return sum;
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::size_t reach = std::min<std::size_t>(i, 16);
    std::vector<std::int64_t> all;
    for (std::size_t step = 1; step <= reach; ++step) all.push_back(distance(i, i - step));
    std::sort(all.begin(), all.end());
    for (unsigned n = 0; n < 3; ++n) {
      const std::size_t step = window.of(i)[n];
      ASSERT_GE(step, 1U);
      ASSERT_LE(step, reach);
      EXPECT_EQ(distance(i, i - step), all[std::min<std::size_t>(n, reach - 1)]);
    }
  }
}

TEST(OrderedWords, SortAsTheNumbersDo) {
  const std::vector<float> ascending{-3e38F, -1.5F, -1e-45F, 0.0F, 1e-45F, 2.0F, 3e38F};
  std::uint32_t last = 0;
  for (const float f : ascending) {
    const auto word = wordOfNumber<std::uint32_t>(static_cast<double>(f));
    EXPECT_GT(word, last);
    EXPECT_EQ(numberOfWord(word), static_cast<double>(f));
    last = word;
  }
  for (unsigned bits = 0; bits < 256; ++bits) {
    const auto byte = static_cast<std::uint8_t>(bits);
    for (const NumberKind kind : {NumberKind::Unsigned, NumberKind::Signed, NumberKind::Float}) {
      EXPECT_EQ(bitsOfWord(orderedWord(byte, kind), kind), byte);
    }
  }
}

double cosine(const OctahedralMap::Vector& a, const OctahedralMap::Vector& b) {
  const auto product = [](const OctahedralMap::Vector& v, const OctahedralMap::Vector& w) {
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  };
  return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

TEST(OctahedralMap, PlacesComeBackAndLieNearTheirDirections) {
  for (const std::uint32_t half : {1U, 15U, 300U, OctahedralMap::kMostHalf}) {
    const OctahedralMap map(half);
    const std::uint32_t last = 2 * half;
    for (std::uint32_t u = 0; u <= last; u += 1 + last / 40) {
      for (std::uint32_t v = 0; v <= last; v += 1 + last / 40) {
        const OctahedralMap::Vector d = map.direction({u, v});
        EXPECT_NEAR(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1, 1e-12);
        // Places on the border of the square may have the same point; all are one place then.
        const OctahedralMap::Point point = map.point({u, v});
        EXPECT_EQ(std::abs(point[0]) + std::abs(point[1]) + std::abs(point[2]),
                  static_cast<std::int32_t>(half));
        EXPECT_EQ(map.point(map.placeOf(point)), point);
        EXPECT_EQ(map.place(d), map.placeOf(point));
      }
    }
  }
}

TEST(OctahedralMap, ChartsKeepPlacesAndPutNeighboursBesideEachOther) {
  const OctahedralMap map(50);
  for (const OctahedralMap::Vector& v :
       {OctahedralMap::Vector{0.3, 0.2, -0.8}, {-0.7, 0.1, 0.1}, {0.2, -0.9, 0}, {0, 0, 0}}) {
    const OctahedralChart chart(v);
    for (std::uint32_t place = 0; place <= 100; ++place) {
      const OctahedralMap::Place given = map.placeOf(map.point({place, place * place % 101}));
      EXPECT_EQ(chart.fromChart(map, chart.toChart(map, given)), given);
    }
    const OctahedralMap::Place middle = chart.place(map, v);
    if (v != OctahedralMap::Vector{}) {
      EXPECT_GT(cosine(map.direction(chart.fromChart(map, middle)), v), std::cos(1.5 / 50));
    }
    for (const OctahedralMap::Place& beside :
         {OctahedralMap::Place{middle[0] + 1, middle[1]}, {middle[0], middle[1] - 1}}) {
      const OctahedralMap::Vector a = map.direction(chart.fromChart(map, middle));
      const OctahedralMap::Vector b = map.direction(chart.fromChart(map, beside));
      EXPECT_GT(cosine(a, b), std::cos(2.5 / 50));
    }
  }
}

TEST(LogisticTables, AreMonotonousAndInverse) {
  const LogisticTables& tables = LogisticTables::instance();
  for (int odds = -LogisticTables::kMaxOdds; odds < LogisticTables::kMaxOdds; ++odds) {
    EXPECT_LE(tables.probability(odds), tables.probability(odds + 1));
  }
  EXPECT_EQ(tables.probability(0), 32768U);
  EXPECT_NEAR(tables.odds(32768), 0, 1);
  for (std::uint32_t p = 1024; p < 65536 - 1024; p += 16) {
    EXPECT_NEAR(static_cast<double>(tables.probability(tables.odds(p))), p, 80);
  }
}

}  // namespace
}  // namespace bspc::attributes
