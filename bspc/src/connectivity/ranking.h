#pragma once

#include <cstdint>
#include <vector>

#include "connectivity/advancing_front.h"
#include "connectivity/candidate.h"
#include "connectivity/candidate_weights.h"
#include "connectivity/gate_frame.h"

namespace bspc::connectivity {

/// The vertices that could come next at a gate, the likeliest first.
struct Ranking {
  Gate gate;
  std::vector<Candidate> candidates;
  float apexCosine = 0;  ///< of the face across, see GateFrame
  bool longest = false;
};

/// How far a ranking looks.
struct RankingReach {
  unsigned neighbours = 0;  ///< of each of two places near the gate
  unsigned candidates = 0;  ///< that are kept
  VertexIndex::Among among = VertexIndex::Among::Awake;
};

/// Finds candidates at gates and ranks them. The same on both sides.
class Ranker {
 public:
  Ranker(const AdvancingFront& front, const CandidateWeights& weights)
      : front_(front), weights_(weights) {}

  void rank(const Gate& gate, const RankingReach& reach, Ranking& ranking);

 private:
  void gather(const Gate& gate, const GateFrame& frame, const RankingReach& reach);
  void consider(const Gate& gate, std::uint32_t vertex);
  void nearest(const Gate& gate, const Position& place, const RankingReach& reach);
  Candidate describe(const Gate& gate, const GateFrame& frame, std::uint32_t vertex) const;
  void describeFolds(const Gate& gate, const GateFrame& frame, const Vector& toCandidate,
                     const Vector& normal, Candidate& c) const;
  void describeValences(const Gate& gate, bool gluesFirst, bool gluesSecond, Candidate& c) const;
  void describeGaps(const GateFrame& frame, const Vector& toCandidate, const Vector& fromEnd,
                    bool gluesFirst, bool gluesSecond, Candidate& c) const;
  void compareCotangents(std::vector<Candidate>& candidates);

  const AdvancingFront& front_;
  const CandidateWeights& weights_;
  std::vector<std::uint32_t> found_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> byCotangent_;
};

}  // namespace bspc::connectivity
