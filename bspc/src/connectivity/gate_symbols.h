#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "connectivity/ranking.h"
#include "entropy/counter.h"
#include "entropy/logistic_mixer.h"

namespace bspc::connectivity {

/// Codes what comes at a gate, given its ranking: whether it is a border, and which candidate the
/// next vertex is. Each decision is predicted by the ranking's probabilities and by what was seen
/// in several contexts, mixed.
class GateSymbols {
 public:
  GateSymbols();

  /// Whether no face comes at the gate.
  template <class Coder>
  bool border(Coder& coder, const AdvancingFront& front, const Ranking& ranking, bool value) {
    gatherBorder(front, ranking);
    value = border_.code(coder, value, evidence_, selection_);
    learn(value, kBorderAge);
    recentBorder_ = value ? kRecent : std::max(recentBorder_, 1U) - 1;
    anyBorder_ = anyBorder_ || value;
    return value;
  }

  /// The place in the ranking of the next vertex, the size of the ranking if it is not there.
  template <class Coder>
  std::size_t candidate(Coder& coder, const AdvancingFront& front, const Ranking& ranking,
                        std::size_t value) {
    const std::size_t count = ranking.candidates.size();
    float rest = 1;
    std::size_t at = 0;
    while (at < count) {
      gatherCandidate(front, ranking, at, rest);
      const bool hit = candidate_.code(coder, at == value, evidence_, selection_);
      learn(hit, kCandidateAge);
      if (hit) break;
      rest -= ranking.candidates[at].probability;
      ++at;
    }
    remember(at < count ? at : 2);
    return at;
  }

 private:
  static constexpr unsigned kRecent = 21;
  static constexpr unsigned kBorderAge = 255;
  static constexpr unsigned kCandidateAge = 255;
  static constexpr unsigned kContexts = 10;
  static constexpr unsigned kBorderContexts = 3;

  using Mixer = entropy::LogisticMixer<1>;

  void gatherBorder(const AdvancingFront& front, const Ranking& ranking);
  void gatherCandidate(const AdvancingFront& front, const Ranking& ranking, std::size_t at,
                       float rest);
  void addContext(entropy::Counter& counter, float prior);
  void learn(bool bit, unsigned age) {
    for (entropy::Counter* counter : used_) counter->update(bit, age);
  }
  void remember(std::size_t place) {
    history_[2] = history_[1];
    history_[1] = history_[0];
    history_[0] = static_cast<unsigned>(std::min<std::size_t>(place, 2));
  }

  entropy::Evidence evidence_;
  std::array<std::vector<entropy::Counter>, kContexts> contexts_;
  std::array<std::vector<entropy::Counter>, kBorderContexts> borderContexts_;
  Mixer candidate_;
  Mixer border_;
  std::vector<entropy::Counter*> used_;
  Mixer::Selection selection_{};
  std::array<unsigned, 3> history_{};  ///< places of the last vertices, at most 2
  unsigned recentBorder_ = 0;
  bool anyBorder_ = false;
};

}  // namespace bspc::connectivity
