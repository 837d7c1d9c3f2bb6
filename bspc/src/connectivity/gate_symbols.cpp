#include "connectivity/gate_symbols.h"

#include "entropy/logistic_math.h"

namespace bspc::connectivity {

namespace {

constexpr float kBiasInput = 0.3F;
constexpr unsigned kPlaces = 4;   ///< classes of places in a ranking
constexpr unsigned kMargins = 8;  ///< classes of the lead over the next candidate

/// The number of a context, made of classes.
class ContextNumber {
 public:
  ContextNumber& with(unsigned value, unsigned classes) {
    number_ = number_ * classes + std::min(value, classes - 1);
    return *this;
  }
  std::size_t number() const { return number_; }

 private:
  std::size_t number_ = 0;
};

float logit(float p) {
  p = entropy::clamped(p, 1e-5F, 1 - 1e-5F);
  return entropy::naturalLog(p) - entropy::naturalLog(1 - p);
}

unsigned cotangentClass(float cotangent) {
  constexpr std::array<float, 6> kBounds{0, 0.35F, 0.58F, 1, 1.7F, 3};
  unsigned c = 0;
  while (c < kBounds.size() && cotangent >= kBounds[c]) ++c;
  return c;
}

/// What a gate and its kind multiply the contexts of candidates by.
constexpr std::size_t kStages = std::size_t{kPlaces} * kKinds * kGateKinds;
/// Contexts of each of the ten sorts in gatherCandidate, without the stages.
constexpr std::array<unsigned, 10> kContextSizes{20, 32, 126, 1000, 40, 60, 224, 270, 192, 448};
constexpr std::array<unsigned, 3> kBorderContextSizes{24, 384, 288};

}  // namespace

GateSymbols::GateSymbols()
    : candidate_({static_cast<unsigned>(2 * kStages)}, kContexts + 2, 0.12F, {0.015F, 300, 0.003F},
                 kCandidateAge),
      border_({6}, kBorderContexts + 1, 0.4F, {0.03F, 300, 0.01F}, kBorderAge) {
  for (unsigned i = 0; i < kContexts; ++i) contexts_[i].resize(kStages * kContextSizes[i]);
  for (unsigned i = 0; i < kBorderContexts; ++i) borderContexts_[i].resize(kBorderContextSizes[i]);
  candidate_.startWeight(0, 0.6F);
  candidate_.startWeight(kContexts + 1, 0);
}

void GateSymbols::addContext(entropy::Counter& counter, float prior) {
  evidence_.add(counter.evidence() + (1 - counter.confidence()) * prior);
  used_.push_back(&counter);
}

void GateSymbols::gatherBorder(const AdvancingFront& front, const Ranking& ranking) {
  evidence_.clear();
  used_.clear();
  const Edge edge = ranking.gate.edge;
  const unsigned beside =
      (front.borderEndsAt(edge.from) ? 1U : 0U) + (front.borderBeginsAt(edge.to) ? 1U : 0U);
  unsigned score = 0;
  unsigned kind = 0;
  unsigned fold = 0;
  unsigned size = 0;
  unsigned overlap = 0;
  if (!ranking.candidates.empty()) {
    const Candidate& best = ranking.candidates[0];
    score = 1 + entropy::classOf(best.score, 0.5F, 3, 7);
    kind = best.kind;
    fold = entropy::classOf(best.feature[kFold], 2.5F, 0, 4);
    size = entropy::classOf(best.feature[kPerimeter], 3, 2, 8);
    overlap = entropy::classOf(best.feature[kOverlap], 1, 0, 3);
  }
  const auto context = [&](unsigned i, const ContextNumber& c) -> entropy::Counter& {
    return borderContexts_[i][c.number()];
  };
  constexpr float kUnseen = -2;
  addContext(context(0, ContextNumber().with(beside, 3).with((recentBorder_ + 2) / 3, 8)), kUnseen);
  addContext(context(1, ContextNumber().with(score, 8).with(kind, 4).with(beside, 3).with(fold, 4)),
             kUnseen);
  addContext(
      context(2, ContextNumber().with(size, 8).with(beside, 3).with(kind, 4).with(overlap, 3)),
      kUnseen);
  evidence_.add(kBiasInput);
  selection_[0] = beside * 2 + (anyBorder_ ? 1 : 0);
}

void GateSymbols::gatherCandidate(const AdvancingFront& front, const Ranking& ranking,
                                  std::size_t at, float rest) {
  evidence_.clear();
  used_.clear();
  const Candidate& c = ranking.candidates[at];
  const bool last = at + 1 == ranking.candidates.size();
  const float p = last ? 0.7F : rest > 1e-9F ? c.probability / rest : 0.5F;
  const float prior = logit(p);
  const Candidate& next = ranking.candidates[last ? at : at + 1];
  const unsigned margin = last ? kMargins - 1 : entropy::classOf(c.score - next.score, 1.5F, 0, 8);

  const auto place = static_cast<unsigned>(std::min<std::size_t>(at, kPlaces - 1));
  const unsigned stage = gateKind(ranking.gate);
  const unsigned sure = entropy::classOf(prior, 1.2F, 8, 20);
  const unsigned nextKind = last ? 0 : next.kind;
  const unsigned angle = cotangentClass(c.cotangent);
  const unsigned away = entropy::classOf(c.feature[kParallelogram], 8, 0, 8);
  const unsigned rank = entropy::classOf(c.feature[kRank], 2, 0, 5);
  const unsigned overlap = entropy::classOf(c.feature[kOverlap], 1, 0, 3);
  const unsigned fold = entropy::classOf(c.feature[kFold], 4, 0, 6);
  const unsigned glueFold = entropy::classOf(c.feature[kGlueFold], 4, 0, 4);
  const unsigned apexAngle = entropy::classOf(ranking.apexCosine, 4, 4, 8);
  const unsigned longest = (ranking.longest ? 2U : 0U) + (c.feature[kLongestKept] > 0 ? 1U : 0U);
  const Edge edge = ranking.gate.edge;

  const auto start = [&](unsigned shownPlace) {
    return ContextNumber().with(shownPlace, kPlaces).with(c.kind, kKinds).with(stage, kGateKinds);
  };
  const auto add = [&](unsigned i, const ContextNumber& number) {
    addContext(contexts_[i][number.number()], 0.8F * prior);
  };
  evidence_.add(prior);
  add(0, start(place).with(sure, 20));
  add(1, start(place).with(margin, 8).with(nextKind, 4));
  add(2, start(place).with(angle, 7).with(fold, 6).with(overlap, 3));
  add(3, start(std::min(place, 1U))
             .with(front.valence(edge.from), 10)
             .with(front.valence(edge.to), 10)
             .with(front.valence(c.vertex), 10));
  add(4, start(place).with(away, 8).with(sure / 4, 5));
  add(5, start(place).with(rank, 5).with(glueFold, 4).with(overlap, 3));
  add(6, start(place).with(angle, 7).with(apexAngle, 8).with(longest, 4));
  add(7, start(place)
             .with(history_[0], 3)
             .with(history_[1], 3)
             .with(history_[2], 3)
             .with(sure / 2, 10));
  add(8, start(place).with(apexAngle, 8).with(fold, 6).with(glueFold, 4));
  add(9, start(std::min(place, 1U)).with(angle, 7).with(away, 8).with(margin, 8));
  evidence_.add(kBiasInput);
  selection_[0] = static_cast<unsigned>(start(place).with(margin >= 4 ? 1 : 0, 2).number());
}

}  // namespace bspc::connectivity
