#include "connectivity/candidate_weights.h"

#include "entropy/logistic_math.h"

namespace bspc::connectivity {

namespace {

constexpr float kRate = 0.03F;
/// Errors below this teach nothing worth the time.
constexpr float kSmallError = 0.003F;

/// The weights of a feature for each kind of candidate.
struct FirstWeights {
  Feature feature;
  std::array<float, kKinds> weights;
};

/// Set by hand, a tenth of the way towards what bumpy spheres and terrains teach: further on, and
/// meshes of other sorts suffer.
constexpr std::array<FirstWeights, 10> kFirstWeights{{
    {kBias, {0.8F, 1.2F, 1.2F, -1.4F}},
    {kCotangent, {-2.8F, -2.8F, -2.8F, -2.8F}},
    {kCosine, {-0.2F, -0.2F, 0, 0}},
    {kFold, {-2.2F, -2, -2, -2}},
    {kPerimeterChange, {-0.2F, 0, 0, -0.2F}},
    {kPerimeter, {-0.4F, -0.2F, 0, -0.2F}},
    {kParallelogram, {0.2F, 0, 0, 0.2F}},
    {kParallelogramLog, {0, 0.2F, -0.2F, 0}},
    {kOverlap, {-1.2F, -1, -1, -1.2F}},
    {kRank, {-1, -1, -1, -1}},
}};

}  // namespace

CandidateWeights::CandidateWeights() {
  for (unsigned i = 0; i < weights_.size(); ++i) {
    weights_[i] = {};
    for (const FirstWeights& first : kFirstWeights) {
      weights_[i][first.feature] = first.weights[i % kKinds];
    }
  }
}

void CandidateWeights::learn(unsigned gateKind, const std::vector<Candidate>& candidates,
                             std::size_t chosen) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const float error = (i == chosen ? 1.0F : 0.0F) - c.probability;
    if (entropy::magnitude(error) < kSmallError) continue;
    Weights& w = weights_[std::size_t{gateKind} * kKinds + c.kind];
    const float step = kRate * error;
    for (unsigned f = 0; f < kFeatures; ++f) w[f] += step * c.feature[f];
  }
}

}  // namespace bspc::connectivity
