#pragma once

#include <array>
#include <vector>

#include "connectivity/advancing_front.h"
#include "connectivity/candidate.h"

namespace bspc::connectivity {

constexpr unsigned kKinds = 4;
/// Kinds of gates: first, with a face across, diagonal; each for a face's last vertex or another.
constexpr unsigned kGateKinds = 6;

inline unsigned gateKind(const Gate& gate) {
  const unsigned kind = gate.apex == kNoVertex ? 1 : gate.diagonal ? 2 : 0;
  return kind + (gate.closing ? 0 : 3);
}

/// Weights of the features, for each kind of candidate and gate. They start from values set by
/// hand and are learned from every vertex that is coded.
class CandidateWeights {
 public:
  using Weights = std::array<float, kFeatures>;

  CandidateWeights();

  const Weights& of(unsigned gateKind, unsigned candidateKind) const {
    return weights_[std::size_t{gateKind} * kKinds + candidateKind];
  }
  float score(unsigned gateKind, const Candidate& candidate) const {
    const Weights& w = of(gateKind, candidate.kind);
    float sum = 0;
    for (unsigned f = 0; f < kFeatures; ++f) sum += w[f] * candidate.feature[f];
    return sum;
  }
  /// One step up the gradient of ln(probability of the candidate at `chosen`).
  void learn(unsigned gateKind, const std::vector<Candidate>& candidates, std::size_t chosen);

 private:
  std::array<Weights, std::size_t{kGateKinds} * kKinds> weights_;
};

}  // namespace bspc::connectivity
