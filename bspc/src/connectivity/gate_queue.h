#pragma once

#include <array>
#include <vector>

#include "connectivity/ranking.h"
#include "entropy/logistic_math.h"

namespace bspc::connectivity {

/// Open gates in the order in which they are to be coded: the surest first, of equally sure ones
/// the newest. What is coded early helps to decide what is less sure.
class GateQueue {
 public:
  static constexpr unsigned kClasses = 24;

  /// Class of a gate whose vertices are ranked so, 0 for the surest: by −ln(1 − p), p being the
  /// probability of the best candidate, later if its score says that it is a bad one all the same.
  static unsigned classOf(const Ranking& ranking) {
    if (ranking.candidates.empty()) return kClasses - 1;
    const Candidate& best = ranking.candidates[0];
    const float rest = entropy::clamped(1 - best.probability, 1e-6F, 1);
    constexpr float kLeast = -13.82F;  // about ln(1e-6)
    const unsigned doubt = entropy::classOf(entropy::naturalLog(rest) - kLeast,
                                            (kClasses - 2) / -kLeast, 0, kClasses - 1);
    const unsigned bad = best.score < -3 ? 5 : best.score < -1 ? 3 : 0;
    return std::min(doubt + bad, kClasses - 2);
  }

  void push(unsigned priority, Edge edge) { classes_[priority].push_back(edge); }

  /// Takes the first gate out; false if there is none.
  bool pop(Edge& edge, unsigned& priority) {
    for (priority = 0; priority < kClasses; ++priority) {
      std::vector<Edge>& gates = classes_[priority];
      if (gates.empty()) continue;
      edge = gates.back();
      gates.pop_back();
      return true;
    }
    return false;
  }

 private:
  std::array<std::vector<Edge>, kClasses> classes_;
};

}  // namespace bspc::connectivity
