#include "connectivity/candidate_weights.h"

#include "entropy/logistic_math.h"

namespace bspc::connectivity {

namespace {

constexpr float kRate = 0.02F;
/// Errors below this teach nothing worth the time.
constexpr float kSmallError = 0.003F;

CandidateWeights::Weights startOf(unsigned candidateKind) {
  constexpr std::array<float, kKinds> kBiases{0, 0.5F, 1, -2};
  CandidateWeights::Weights w{};
  w[kBias] = kBiases[candidateKind];
  w[kCotangent] = -3;
  w[kFold] = -2;
  w[kOverlap] = -1;
  w[kRank] = -1;
  return w;
}

}  // namespace

CandidateWeights::CandidateWeights() {
  for (unsigned i = 0; i < weights_.size(); ++i) weights_[i] = startOf(i % kKinds);
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
