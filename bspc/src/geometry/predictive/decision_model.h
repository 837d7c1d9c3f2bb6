#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "entropy/counter.h"
#include "entropy/logistic_mixer.h"
#include "geometry/predictive/predictors.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Codes how the points of a box are shared out between its halves: makes inputs and contexts of
/// what the predictors say, and mixes them. All that is learned from decision to decision is here.
class DecisionModel {
 public:
  DecisionModel() {
    for (unsigned i = 0; i < kSideContexts; ++i) side_[i].resize(kSideSizes[i]);
    for (unsigned i = 0; i < kCountContexts; ++i) count_[i].resize(kCountSizes[i]);
    for (unsigned i = 0; i < 2; ++i) share_[i].resize(kShareSizes[i]);
    for (unsigned i = 0; i < kFlatContexts; ++i) flat_[i].resize(kFlatSizes[i]);
  }

  /// Codes `upper`, the number of the `count` ≥ 1 points of the question's box that lie in its
  /// upper half. The predictors have been asked.
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t upper, std::uint32_t count, const Question& q,
                     const Predictors& p) {
    const Situation s(q, p);
    if (count == 1) return codeSide(coder, upper != 0, kLonePoint, s, q, p) ? 1 : 0;
    if (count <= kSmall) return codeSmall(coder, upper, count, s, q, p);
    return codeLarge(coder, upper, count, s, q, p);
  }

  /// Whether the only point of a flat box lies in its upper half. The predictors have been asked
  /// by askFlat().
  template <class Coder>
  bool codeFlat(Coder& coder, bool upper, const Question& q, const Predictors& p);

 private:
  static constexpr std::uint32_t kSmall = 8;
  static constexpr unsigned kLogits = kLogitClasses;
  static constexpr unsigned kCoarse = 17;  ///< and coarsely
  static constexpr unsigned kSizes = 18;   ///< classes of the box's size in spacings
  static constexpr unsigned kErrors = 10;
  static constexpr unsigned kSurfaceErrors = 12;
  static constexpr unsigned kMasses = 11;
  static constexpr unsigned kOpens = 22;
  static constexpr unsigned kDistances = Coordinates::kDistanceClasses;
  static constexpr unsigned kValues = AxisValues::kClasses;
  static constexpr unsigned kCounts = 50;   ///< classes of (points, unary place)
  static constexpr unsigned kDoubts = 8;    ///< how undecided the surface is, or the density
  static constexpr unsigned kBalances = 6;  ///< how evenly parallelograms are shared out

  /// What a side decision is about: the only point of a box, one of two points, one of more.
  enum SideKind : unsigned { kLonePoint, kOneOfTwo, kMajority, kSideKinds };

  static unsigned fine(float logit) { return logitClass(logit); }
  static unsigned coarse(float logit) { return entropy::classOf(logit, 2, 8.5F, kCoarse); }

  /// Classes that several contexts share.
  struct Situation {
    Situation(const Question& q, const Predictors& p)
        : size(sizeClass(q, p)),
          surface(fine(p.surfaceEvidence())),
          open(std::min(q.open, kOpens - 1)) {
      if (!p.inCell) {
        lowerDistance = p.density.lowerDistance;
        upperDistance = p.density.upperDistance;
        return;
      }
      lowerDistance = p.coordinates.lowerDistance;
      upperDistance = p.coordinates.upperDistance;
      error = static_cast<unsigned>(
          std::clamp(entropy::halfOctave(p.candidateError) + 10, 0, int{kErrors} - 1));
      float sum = 0.01F;
      for (unsigned kind = 0; kind < Candidates::kKinds; ++kind) {
        if (!p.candidates.speaks(kind)) continue;
        candidate[kind] = coarse(p.candidates.answer[kind][0].evidence);
        if (kind == Candidates::kProjected) continue;
        const Candidates::Answer& widest = p.candidates.widest(kind);
        sum += widest.lower + widest.upper;
      }
      mass = static_cast<unsigned>(std::clamp((entropy::halfOctave(sum) >> 1) + 7, 0, 9)) + 1;
    }

    static unsigned sizeClass(const Question& q, const Predictors& p) {
      const int octaves = entropy::halfOctave(q.size[q.axis] / p.spacing);
      return static_cast<unsigned>(std::clamp(octaves + 10, 0, int{kSizes} - 1));
    }

    unsigned size;
    unsigned surface;
    unsigned open;
    unsigned lowerDistance = 0;
    unsigned upperDistance = 0;
    unsigned error = 5;
    unsigned mass = 0;  ///< of candidates in the box; 0 if there is no telling
    std::array<unsigned, Candidates::kKinds> candidate{kCoarse / 2, kCoarse / 2, kCoarse / 2};
  };

  using Counters = std::vector<entropy::Counter>;

  template <class Coder>
  bool codeSide(Coder& coder, bool upper, SideKind kind, const Situation& s, const Question& q,
                const Predictors& p);
  void addSideContexts(unsigned z, const Situation& s, const Question& q, const Predictors& p);

  /// The smaller half in unary, then which half that is.
  template <class Coder>
  std::uint32_t codeSmall(Coder& coder, std::uint32_t upper, std::uint32_t count,
                          const Situation& s, const Question& q, const Predictors& p) {
    const std::uint32_t wanted = std::min(upper, count - upper);
    std::uint32_t less = 0;
    while (less < count / 2 && codeMore(coder, less < wanted, count, less, s, q, p)) ++less;
    if (2 * less == count) return less;
    const bool mostUpper =
        codeSide(coder, 2 * upper > count, count == 2 ? kOneOfTwo : kMajority, s, q, p);
    return mostUpper ? count - less : less;
  }

  /// Whether a half is empty; if not, bisection of the counts that are possible.
  template <class Coder>
  std::uint32_t codeLarge(Coder& coder, std::uint32_t upper, std::uint32_t count,
                          const Situation& s, const Question& q, const Predictors& p) {
    if (!codeMore(coder, upper > 0 && upper < count, kSmall + 1, 0, s, q, p)) {
      return codeSide(coder, upper == count, kMajority, s, q, p) ? count : 0;
    }
    std::uint32_t low = 1;
    std::uint32_t high = count - 1;
    for (unsigned depth = 0; low < high; ++depth) {
      const std::uint32_t middle = low + (high - low) / 2 + (high - low) % 2;
      if (codeShare(coder, upper >= middle, {count, depth, low, middle, high}, s, p)) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    return low;
  }

  /// Whether the smaller half has more than `less` of the points.
  template <class Coder>
  bool codeMore(Coder& coder, bool more, std::uint32_t count, std::uint32_t less,
                const Situation& s, const Question& q, const Predictors& p);

  struct Bisection {
    std::uint32_t count;
    unsigned depth;
    std::uint32_t low;
    std::uint32_t middle;
    std::uint32_t high;
  };
  /// Whether the upper half has at least `middle` points, which lie between `low` and `high`.
  template <class Coder>
  bool codeShare(Coder& coder, bool reached, const Bisection& b, const Situation& s,
                 const Predictors& p);
  static float shareEvidence(const Bisection& b, float probability, float widening, float floor);

  static constexpr unsigned kPhaseOpens = 8;  ///< sizes of boxes in which phases speak
  static constexpr unsigned kSideContexts = 12;
  static constexpr std::array<unsigned, kSideContexts> kSideSizes{
      kSideKinds * kLogits * kSizes,        kSideKinds* kCoarse* kCoarse* kMasses,
      kSideKinds* kDistances* kDistances,   kSideKinds* kCoarse* kLogits,
      kSideKinds* kValues* kValues* kOpens, kSideKinds* kLogits* kSizes,
      kSideKinds* kCoarse* kCoarse * 3,     kSideKinds* kCoarse* kSizes,
      kSideKinds* kLogits* kLogits,         kSideKinds* kCoarse* kSizes,
      kSideKinds* kLogits* kSurfaceErrors,  kSideKinds* kLogits* kPhaseOpens};
  static constexpr unsigned kCountContexts = 6;
  static constexpr std::array<unsigned, kCountContexts> kCountSizes{kCounts * kSizes,
                                                                    kCounts* kDoubts* kSizes,
                                                                    kCounts* kDoubts* kBalances * 3,
                                                                    kCounts* kDistances* kDistances,
                                                                    kCounts* kDoubts*(kSizes / 3),
                                                                    kCounts* kLogits* kPhaseOpens};
  static constexpr unsigned kBisections = 8;
  static constexpr unsigned kCountOctaves = 21;
  static constexpr std::array<unsigned, 2> kShareSizes{kBisections * kLogits * kCountOctaves,
                                                       kBisections* kLogits* kSizes};

  static constexpr unsigned kFlatOpens = 16;
  static constexpr unsigned kFlatPlaces = 3 * kFlatOpens;
  static constexpr unsigned kFlatContexts = 3;
  static constexpr std::array<unsigned, kFlatContexts> kFlatSizes{
      kFlatPlaces * kLogits, kFlatPlaces* kValues* kValues, kFlatPlaces* kLogits};

  static constexpr unsigned kInputs = 32;
  static constexpr float kWeight = 0.12F;
  static constexpr float kFlatWeight = 0.06F;
  static constexpr float kLayeredWeight = 0.12F;
  static constexpr float kLayeredCountWeight = 0.2F;
  static constexpr entropy::MixingRate kFinalRate{0.015F, 10, 0.003F};
  static constexpr unsigned kCounterAge = 60;
  static constexpr unsigned kLayeredCounterAge = 120;  ///< of sides
  static constexpr unsigned kSideSets = 2 * kSideKinds * kSizes * 3;
  static constexpr unsigned kSidesPerPhase = kSideKinds * kMasses * kErrors;

  std::array<Counters, kSideContexts> side_;
  std::array<Counters, kCountContexts> count_;
  std::array<Counters, 2> share_;
  std::array<Counters, kFlatContexts> flat_;
  entropy::Evidence evidence_;
  entropy::LogisticMixer<2> sideMixer_{
      {kSideSets + kSideKinds * 3 * kPhaseOpens, kSidesPerPhase + kSideKinds},
      kInputs,
      kWeight,
      {},
      kCounterAge};
  entropy::LayeredMixer<6, 2> layeredMixer_{
      {kSideSets + kSideKinds * 3 * kPhaseOpens, 2 * kSideKinds* kDistances,
       kSideKinds* kMasses* kOpens, kSideKinds* kCoarse* kCoarse, 2 * kSideKinds* kLogits,
       kSidesPerPhase + kSideKinds},
      {2 * kSideKinds, 2 * kSideKinds* kErrors * 3},
      kInputs,
      kLayeredWeight,
      {0.04F, 400, 0.007F},
      kLayeredCounterAge,
      kFinalRate};
  entropy::LogisticMixer<2> countMixer_{{2 * kCounts, kCounts}, kInputs, kWeight, {}, kCounterAge};
  entropy::LayeredMixer<4, 2> layeredCountMixer_{
      {2 * kCounts, kCounts* kSizes, kCounts* kDoubts* kBalances, kCounts * 2 * 3},
      {kCounts, 2},
      kInputs,
      kLayeredCountWeight,
      {0.05F, 200, 0.005F},
      kCounterAge,
      kFinalRate};
  entropy::LogisticMixer<2> shareMixer_{
      {kBisections, kBisections}, kInputs, kWeight, {}, kCounterAge};
  entropy::LogisticMixer<1> flatMixer_{{2 * kFlatPlaces}, kInputs, kFlatWeight, {}, kCounterAge};
};

template <class Coder>
bool DecisionModel::codeSide(Coder& coder, bool upper, SideKind kind, const Situation& s,
                             const Question& q, const Predictors& p) {
  const Features& f = p.features;
  entropy::Evidence& e = evidence_;
  e.clear();
  e.add(1);
  e.add(p.surfaceEvidence());
  if (f.has(Features::kNarrowQuadric)) e.add(p.narrowQuadricEvidence);
  if (f.has(Features::kPlane)) e.add(p.planeEvidence);
  if (f.has(Features::kAxisValues)) e.add(p.axisValues.evidence);
  if (!p.inCell || f.has(Features::kDensity)) e.add(p.density.evidence);
  if (p.inCell) {
    p.candidates.addEvidence(e);
    e.add(p.coordinates.narrow);
    if (f.has(Features::kWideCoordinates)) e.add(p.coordinates.wide);
  }
  addSideContexts(kind, s, q, p);
  const unsigned phase = p.inCell ? 1 : 0;
  const unsigned second = p.inCell ? kSideKinds + (kind * kMasses + s.mass) * kErrors + s.error
                                   : static_cast<unsigned>(kind);
  unsigned first = ((phase * kSideKinds + kind) * kSizes + s.size) * 3 + q.axis;
  if (p.phaseSpeaks) {
    e.add(p.phaseEvidence);
    e.add(side_[11][(kind * kLogits + fine(p.phaseEvidence)) * kPhaseOpens + q.open]);
    first = kSideSets + (kind * 3 + q.axis) * kPhaseOpens + q.open;
  }
  if (!f.has(Features::kTwoLayers)) return sideMixer_.code(coder, upper, e, {first, second});
  const unsigned about = phase * kSideKinds + kind;
  const unsigned nearest = std::min(s.lowerDistance, s.upperDistance);
  return layeredMixer_.code(
      coder, upper, e,
      {first, about * kDistances + nearest, (kind * kMasses + s.mass) * kOpens + s.open,
       (kind * kCoarse + s.candidate[Candidates::kExtrapolated]) * kCoarse +
           s.candidate[Candidates::kParallelogram],
       about * kLogits + s.surface, second},
      {about, (about * kErrors + s.error) * 3 + q.axis});
}

inline void DecisionModel::addSideContexts(unsigned z, const Situation& s, const Question& q,
                                           const Predictors& p) {
  const Features& f = p.features;
  // Two layers select their weights by the surface and the projected candidates: contexts of these
  // say nothing new there.
  const bool oneLayer = !f.has(Features::kTwoLayers);
  const auto add = [this](unsigned context, unsigned index) {
    evidence_.add(side_[context][index]);
  };
  const unsigned zSurface = z * kLogits + s.surface;
  const auto& c = s.candidate;
  add(0, zSurface * kSizes + s.size);
  add(1, ((z * kCoarse + c[Candidates::kExtrapolated]) * kCoarse + c[Candidates::kParallelogram]) *
                 kMasses +
             s.mass);
  if (!p.inCell || f.has(Features::kNearest)) {
    add(2, (z * kDistances + s.lowerDistance) * kDistances + s.upperDistance);
  }
  if (oneLayer && (!p.inCell || f.has(Features::kProjection))) {
    add(3, (z * kCoarse + c[Candidates::kProjected]) * kLogits + s.surface);
  }
  if (f.has(Features::kAxisValues)) {
    const AxisValues& a = p.axisValues;
    add(4, ((z * kValues + a.lowerClass) * kValues + a.upperClass) * kOpens + s.open);
  }
  if (!f.has(Features::kManyContexts)) return;
  const unsigned narrow = p.inCell ? coarse(p.coordinates.narrow) : kCoarse / 2;
  add(5, (z * kLogits + entropy::classOf(p.density.evidence, 3, 12.5F, kLogits)) * kSizes + s.size);
  add(6, ((z * kCoarse + c[Candidates::kExtrapolated]) * kCoarse + narrow) * 3 + q.axis);
  if (!oneLayer) return;
  const int octaves = entropy::halfOctave(p.surfaceError * p.spacing / q.size[q.axis]);
  const auto error = static_cast<unsigned>(std::clamp(octaves + 6, 0, int{kSurfaceErrors} - 1));
  add(7, (z * kCoarse + narrow) * kSizes + s.size);
  add(8, (z * kLogits + fine(p.planeEvidence)) * kLogits + s.surface);
  add(9, (z * kCoarse + c[Candidates::kProjected]) * kSizes + s.size);
  add(10, zSurface * kSurfaceErrors + error);
}

template <class Coder>
bool DecisionModel::codeFlat(Coder& coder, bool upper, const Question& q, const Predictors& p) {
  const unsigned place = q.axis * kFlatOpens + std::min(q.open, kFlatOpens - 1);
  entropy::Evidence& e = evidence_;
  e.clear();
  e.add(1);
  e.add(p.flat.surfaceEvidence(q));
  for (unsigned kind = 0; kind < Candidates::kKinds; ++kind) {
    if (p.candidates.speaks(kind)) e.add(p.flat.candidateEvidence(q, kind));
  }
  e.add(p.coordinates.narrow);
  e.add(flat_[0][place * kLogits + fine(p.coordinates.narrow)]);
  if (p.features.has(Features::kAxisValues)) {
    const AxisValues& a = p.axisValues;
    e.add(a.evidence);
    e.add(flat_[1][(place * kValues + a.lowerClass) * kValues + a.upperClass]);
  }
  if (p.phaseSpeaks) {
    e.add(p.phaseEvidence);
    e.add(flat_[2][place * kLogits + fine(p.phaseEvidence)]);
  }
  return flatMixer_.code(coder, upper, e, {2 * place + (p.phaseSpeaks ? 1 : 0)});
}

template <class Coder>
bool DecisionModel::codeMore(Coder& coder, bool more, std::uint32_t count, std::uint32_t less,
                             const Situation& s, const Question& q, const Predictors& p) {
  // How undecided a predictor is: 1 at even odds, 0 when it is sure.
  const auto doubt = [](float logit) {
    const float probability = entropy::squash(logit);
    return 4 * probability * (1 - probability);
  };
  entropy::Evidence& e = evidence_;
  e.clear();
  e.add(1);
  const float surface = doubt(p.surfaceEvidence());
  e.add(entropy::naturalLog(surface + 0.02F));
  if (p.features.has(Features::kPlane)) {
    e.add(entropy::naturalLog(doubt(p.planeEvidence) + 0.02F));
  }
  const float sparseness = entropy::magnitude(p.density.evidence);
  if (!p.inCell || p.features.has(Features::kDensity)) e.add(-sparseness);
  unsigned balance = 0;
  if (p.inCell) {
    for (unsigned kind = 0; kind < Candidates::kKinds; ++kind) {
      if (!p.candidates.speaks(kind)) continue;
      const Candidates::Answer& a = p.candidates.widest(kind);
      const float share = (std::min(a.lower, a.upper) + 0.01F) / (a.lower + a.upper + 0.02F);
      e.add(entropy::naturalLog(share) + 1);
      if (kind != Candidates::kProjected)
        balance = 1 + entropy::classOf(share, 10, 0, kBalances - 1);
    }
  }
  const unsigned t = std::min(count, 9U) * 5 + std::min(less, 4U);
  const unsigned doubtClass = entropy::classOf(surface, 7.99F, 0, kDoubts);
  const auto [low, high] = std::minmax(s.lowerDistance, s.upperDistance);
  const auto add = [this](unsigned context, unsigned index) {
    evidence_.add(count_[context][index]);
  };
  add(0, t * kSizes + s.size);
  const unsigned tDoubt = t * kDoubts + doubtClass;
  add(1, tDoubt * kSizes + s.size);
  add(2, (tDoubt * kBalances + balance) * 3 + q.axis);
  add(3, (t * kDistances + low) * kDistances + high);
  add(4, (t * kDoubts + entropy::classOf(sparseness, 3, 0, kDoubts)) * (kSizes / 3) + s.size / 3);
  if (p.phaseSpeaks) add(5, (t * kLogits + fine(p.phaseEvidence)) * kPhaseOpens + q.open);
  const unsigned first = t + (p.phaseSpeaks ? kCounts : 0);
  if (!p.features.has(Features::kTwoLayers)) return countMixer_.code(coder, more, e, {first, t});
  const unsigned about = 2 * t + (p.inCell ? 1 : 0);
  return layeredCountMixer_.code(
      coder, more, e,
      {first, t * kSizes + s.size, tDoubt * kBalances + balance, about * 3 + q.axis},
      {t, p.inCell ? 1U : 0U});
}

/// The number of points in the upper half is spread around its mean.
inline float DecisionModel::shareEvidence(const Bisection& b, float probability, float widening,
                                          float floor) {
  const auto n = static_cast<float>(b.count);
  const float mean = n * probability;
  const float scale = std::sqrt(mean * (1 - probability)) * widening + floor;
  const auto share = [&](float bound) { return entropy::bell((bound - mean) / scale); };
  const float at = share(static_cast<float>(b.middle) - 0.5F);
  const float low = share(static_cast<float>(b.low) - 0.5F);
  const float high = share(static_cast<float>(b.high) + 0.5F);
  return entropy::naturalLog((high - at + 1e-5F) / (at - low + 1e-5F));
}

template <class Coder>
bool DecisionModel::codeShare(Coder& coder, bool reached, const Bisection& b, const Situation& s,
                              const Predictors& p) {
  const float byDensity = shareEvidence(
      b, entropy::squash(0.7F * p.density.evidence + 0.3F * p.planeEvidence), 1.3F, 0.5F);
  const float bySurface = shareEvidence(b, entropy::squash(p.surfaceEvidence()), 2, 0.7F);
  const unsigned depth = std::min(b.depth, kBisections - 1);
  const auto octaves = static_cast<unsigned>(entropy::halfOctave(static_cast<float>(b.count)));
  entropy::Evidence& e = evidence_;
  e.clear();
  e.add(1);
  e.add(byDensity);
  e.add(bySurface);
  e.add(share_[0][(depth * kLogits + fine(byDensity)) * kCountOctaves +
                  std::min(octaves, kCountOctaves - 1)]);
  e.add(share_[1][(depth * kLogits + fine(bySurface)) * kSizes + s.size]);
  return shareMixer_.code(coder, reached, e, {depth, depth});
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
