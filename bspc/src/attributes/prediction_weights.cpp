#include "attributes/prediction_weights.h"

#include <algorithm>
#include <cmath>

namespace bspc::attributes {

namespace {

constexpr unsigned kPlaneTerms = 4;
constexpr unsigned kQuadricTerms = 10;

/// Shares of the sum of weights that are added to the diagonal for slopes and for bends.
constexpr std::array<double, kStiffnesses> kSlopeRidge{0x1p-6, 0x1p-12, 0x1p-16, 0x1p-20};
constexpr std::array<double, kStiffnesses> kBendRidge{0x1p-4, 0x1p-9, 0x1p-13, 0x1p-17};

void inverseDistances(const RankedPoints& points, std::uint32_t rank, WeightedNeighbours& result) {
  double sum = 0;
  for (std::size_t j = 0; j < result.ranks.size(); ++j) {
    const auto distance = static_cast<double>(points.squaredDistance(rank, result.ranks[j]));
    result.weights[j] = 1.0 / (distance + 1.0);
    sum += result.weights[j];
  }
  for (std::size_t j = 0; j < result.ranks.size(); ++j) result.weights[j] /= sum;
}

template <unsigned Terms>
std::array<double, Terms> termsAt(const std::array<double, 3>& p) {
  const double x = p[0];
  const double y = p[1];
  const double z = p[2];
  if constexpr (Terms == kPlaneTerms) {
    return {1, x, y, z};
  } else {
    return {1, x, y, z, x * x, y * y, z * z, x * y, y * z, x * z};
  }
}

/// Solves A b = (1, 0, …) for a symmetric positive definite A, of which the lower triangle is
/// given and overwritten, by its factors L D Lᵀ. False if A is not, as far as rounding tells.
template <unsigned Terms>
bool solveForFirst(std::array<std::array<double, Terms>, Terms>& a, std::array<double, Terms>& b) {
  constexpr double kTiny = 0x1p-46;
  for (unsigned i = 0; i < Terms; ++i) {
    std::array<double, Terms> scaled{};  // L[i][j] · D[j]
    double pivot = a[i][i];
    for (unsigned j = 0; j < i; ++j) {
      double sum = a[i][j];
      for (unsigned k = 0; k < j; ++k) sum -= scaled[k] * a[j][k];
      scaled[j] = sum;
    }
    for (unsigned j = 0; j < i; ++j) {
      a[i][j] = scaled[j] / a[j][j];
      pivot -= scaled[j] * a[i][j];
    }
    if (!(pivot > kTiny)) return false;
    a[i][i] = pivot;
  }
  b.fill(0);
  b[0] = 1;
  for (unsigned i = 1; i < Terms; ++i) {
    for (unsigned k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
  }
  for (unsigned i = 0; i < Terms; ++i) b[i] /= a[i][i];
  for (unsigned i = Terms; i-- > 0;) {
    for (unsigned k = i + 1; k < Terms; ++k) b[i] -= a[k][i] * b[k];
  }
  return true;
}

}  // namespace

/// A point's neighbours in a frame around it, whose unit is the root of their mean squared
/// distance.
struct PredictionWeights::Frame {
  std::array<std::array<double, 3>, NeighbourTable::kMaxNeighbours> offsets{};
  std::array<double, NeighbourTable::kMaxNeighbours> importance{};

  Frame(const RankedPoints& points, std::uint32_t rank, Span<const std::uint32_t> ranks) {
    constexpr double kNear = 0.1;  // keeps the nearest from outweighing all others
    std::array<double, NeighbourTable::kMaxNeighbours> distances{};
    double sum = 0;
    for (std::size_t j = 0; j < ranks.size(); ++j) {
      distances[j] = static_cast<double>(points.squaredDistance(rank, ranks[j]));
      sum += distances[j];
    }
    const double mean = std::max(sum / static_cast<double>(ranks.size()), 1.0);
    const double unit = 1.0 / std::sqrt(mean);
    for (std::size_t j = 0; j < ranks.size(); ++j) {
      for (unsigned k = 0; k < 3; ++k) {
        const std::int64_t d =
            std::int64_t{points.positions[ranks[j]][k]} - points.positions[rank][k];
        offsets[j][k] = static_cast<double>(d) * unit;
      }
      importance[j] = 1.0 / (distances[j] / mean + kNear);
    }
  }
};

template <unsigned Terms>
bool PredictionWeights::fit(const Frame& frame, WeightedNeighbours& result) const {
  std::array<std::array<double, Terms>, NeighbourTable::kMaxNeighbours> terms;
  std::array<std::array<double, Terms>, Terms> normal{};
  double sum = 0;
  const std::size_t count = result.ranks.size();
  for (std::size_t j = 0; j < count; ++j) {
    const double weight = frame.importance[j];
    terms[j] = termsAt<Terms>(frame.offsets[j]);
    sum += weight;
    for (unsigned a = 0; a < Terms; ++a) {
      const double weighted = weight * terms[j][a];
      for (unsigned b = 0; b <= a; ++b) normal[a][b] += weighted * terms[j][b];
    }
  }
  for (unsigned a = 1; a < Terms; ++a) {
    normal[a][a] += (a < kPlaneTerms ? kSlopeRidge : kBendRidge)[stiffness_] * sum;
  }
  std::array<double, Terms> solution{};
  if (!solveForFirst<Terms>(normal, solution)) return false;
  for (std::size_t j = 0; j < count; ++j) {
    double value = 0;
    for (unsigned a = 0; a < Terms; ++a) value += solution[a] * terms[j][a];
    result.weights[j] = value * frame.importance[j];
  }
  return true;
}

void PredictionWeights::find(std::uint32_t rank, Span<const std::uint32_t> neighbours,
                             WeightedNeighbours& result) const {
  const std::size_t wished = neighboursOf(predictor_);
  result.ranks = neighbours.subspan(0, std::min(wished, neighbours.size()));
  const std::size_t count = result.ranks.size();
  if (count == 1) {
    result.weights[0] = 1;
    return;
  }
  if (predictor_ >= Predictor::PlaneOver8 && count >= kPlaneTerms) {
    const Frame frame(points_, rank, result.ranks);
    constexpr std::size_t kQuadricNeighbours = 12;
    if (predictor_ == Predictor::QuadricOver20 && count >= kQuadricNeighbours &&
        fit<kQuadricTerms>(frame, result)) {
      return;
    }
    if (fit<kPlaneTerms>(frame, result)) return;
  }
  inverseDistances(points_, rank, result);
}

}  // namespace bspc::attributes
