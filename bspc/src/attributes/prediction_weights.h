#pragma once

#include <array>
#include <cstdint>

#include "attributes/neighbours.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// How a value is predicted from those of its neighbours.
enum class Predictor : std::uint8_t {
  Nearest = 0,        ///< the nearest one's
  MeanOf3 = 1,        ///< mean of three, weighted by 1 / (squared distance + 1)
  MeanOf8 = 2,        ///< of eight
  PlaneOver8 = 3,     ///< at the point, a linear function fitted to eight
  QuadricOver20 = 4,  ///< a quadratic function fitted to twenty
};
constexpr unsigned kPredictors = 5;

/// How strongly slopes and bends of fitted functions are held back, less the greater.
constexpr unsigned kStiffnesses = 4;

/// Neighbours that a predictor looks at.
constexpr unsigned neighboursOf(Predictor predictor) {
  constexpr std::array<unsigned, kPredictors> kCounts{1, 3, 8, 8, 20};
  return kCounts[static_cast<unsigned>(predictor)];
}

/// A prediction is the sum of weights[j] · value(neighbours[j]), j ascending.
struct WeightedNeighbours {
  Span<const std::uint32_t> ranks;
  std::array<double, NeighbourTable::kMaxNeighbours> weights{};
};

/// Finds the weights for a point; IEEE operations in a written order (docs/format.md, "Arrays").
class PredictionWeights {
 public:
  PredictionWeights(const RankedPoints& points, Predictor predictor, unsigned stiffness)
      : points_(points), predictor_(predictor), stiffness_(stiffness) {}

  /// Weights of the first neighboursOf(predictor) of the neighbours given, in `result`.
  void find(std::uint32_t rank, Span<const std::uint32_t> neighbours,
            WeightedNeighbours& result) const;

 private:
  struct Frame;
  template <unsigned Terms>
  bool fit(const Frame& frame, WeightedNeighbours& result) const;

  const RankedPoints& points_;
  Predictor predictor_;
  unsigned stiffness_;
};

}  // namespace bspc::attributes
