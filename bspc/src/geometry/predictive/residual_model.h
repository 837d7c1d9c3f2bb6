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

/// Codes the only point of a box along one axis: half by half, by how the coordinate is spread
/// around the expected place, and mixes what the coordinates used before say. As DecisionModel does
/// for boxes, it holds all that is learned from decision to decision.
class ResidualModel {
 public:
  ResidualModel()
      : sure_(kSureSize), near_(kNearSize), values_(kValuesSize), phases_(kPhasesSize) {}

  /// Before the first bit along the question's axis. `spacing` in grid steps.
  void startAxis(const Question& q, const AxisResiduals::Expected& expected, float spacing) {
    kind_ = expected.kind;
    place_ = expected.place;
    inverseScale_ = 1 / expected.scale;
    const int octaves = entropy::halfOctave(expected.scale / spacing);
    scaleClass_ = static_cast<unsigned>(std::clamp(octaves + 9, 0, int{kScales} - 1));
    const float low = q.lower[q.axis];
    atLow_ = entropy::bell((low - place_) * inverseScale_);
    atHigh_ = entropy::bell((low + q.size[q.axis] - place_) * inverseScale_);
    isFirst_ = true;
  }

  /// Whether the coordinate lies in the upper half of the question's box.
  template <class Coder>
  bool code(Coder& coder, bool upper, const Question& q, Predictors& p) {
    const float at = entropy::bell((q.middle - place_) * inverseScale_);
    const float evidence = entropy::naturalLog((atHigh_ - at + 1e-4F) / (at - atLow_ + 1e-4F));
    const unsigned open = std::min(q.open, kOpens) - 1;
    upper = entropy::magnitude(evidence) > kSure ? codeSure(coder, upper, evidence, open)
                                                 : codeMixed(coder, upper, evidence, open, q, p);
    (upper ? atLow_ : atHigh_) = at;
    isFirst_ = false;
    return upper;
  }

 private:
  static constexpr unsigned kOpens = 8;         ///< classes of the side's length
  static constexpr unsigned kLongOpens = 16;    ///< where longer ones differ
  static constexpr unsigned kScales = 12;       ///< classes of the scale
  static constexpr unsigned kDistances = 17;    ///< classes of how far the expected place is
  static constexpr float kSure = 2;             ///< logit from which on one half is likely
  static constexpr unsigned kSureClasses = 16;  ///< of logits beyond
  static constexpr unsigned kKinds = AxisResiduals::kKinds;
  static constexpr unsigned kSureSize = kKinds * kOpens * kSureClasses;
  static constexpr unsigned kNearSize = kKinds * 2 * kScales * kDistances * kOpens;
  static constexpr unsigned kValuesSize = kLongOpens * AxisValues::kClasses * AxisValues::kClasses;
  static constexpr unsigned kPhasesSize = 3 * kLongOpens * kLogitClasses;
  static constexpr unsigned kInputs = 6;
  static constexpr float kWeight = 0.3F;
  static constexpr unsigned kCounterAge = 60;

  /// A third of all bits: that the coordinate lies in the half near the expected place is
  /// foreseen well enough by experience alone.
  template <class Coder>
  bool codeSure(Coder& coder, bool upper, float evidence, unsigned open) {
    const bool likelyUpper = evidence > 0;
    const unsigned logit =
        entropy::classOf(entropy::magnitude(evidence) - kSure, 3, 0, kSureClasses);
    entropy::Counter& likely = sure_[(kind_ * kOpens + open) * kSureClasses + logit];
    const bool isLikely = coder.fixedBit(likely.probabilityOfOne(), upper == likelyUpper);
    likely.update(isLikely);
    return isLikely == likelyUpper;
  }

  template <class Coder>
  bool codeMixed(Coder& coder, bool upper, float evidence, unsigned open, const Question& q,
                 Predictors& p) {
    const unsigned longOpen = std::min(q.open, kLongOpens) - 1;
    p.askResidual(q);
    entropy::Evidence& e = evidence_;
    e.clear();
    e.add(evidence);
    e.add(near_[nearContext(q, open)]);
    if (p.features.has(Features::kAxisValues)) {
      const AxisValues& a = p.axisValues;
      e.add(a.evidence);
      e.add(values_[(longOpen * AxisValues::kClasses + a.lowerClass) * AxisValues::kClasses +
                    a.upperClass]);
    }
    if (p.phaseSpeaks) {
      e.add(p.phaseEvidence);
      e.add(
          phases_[(q.axis * kLongOpens + longOpen) * kLogitClasses + logitClass(p.phaseEvidence)]);
    }
    const unsigned set = (kind_ * 3 + q.axis) * kOpens + open;
    return mixer_.code(coder, upper, e, {2 * set + (p.phaseSpeaks ? 1 : 0)});
  }

  /// By how far the expected place is from the middle, in halves of the box.
  unsigned nearContext(const Question& q, unsigned open) const {
    const float halves = (place_ - q.middle) / (0.5F * q.size[q.axis]);
    const unsigned distance = entropy::classOf(halves, 4, 8.5F, kDistances);
    const unsigned about = (kind_ * 2 + (isFirst_ ? 1 : 0)) * kScales + scaleClass_;
    return (about * kDistances + distance) * kOpens + open;
  }

  using Counters = std::vector<entropy::Counter>;
  Counters sure_;
  Counters near_;
  Counters values_;
  Counters phases_;
  entropy::Evidence evidence_;
  entropy::LogisticMixer<1> mixer_{{2 * kKinds * 3 * kOpens}, kInputs, kWeight, {}, kCounterAge};

  // Of the axis at hand.
  unsigned kind_ = 0;
  float place_ = 0;
  float inverseScale_ = 1;
  unsigned scaleClass_ = 0;
  float atLow_ = 0;   ///< distribution function at the lower face of what is left of the box
  float atHigh_ = 0;  ///< and at the upper one
  bool isFirst_ = true;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
