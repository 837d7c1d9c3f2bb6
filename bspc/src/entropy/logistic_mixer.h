#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "entropy/counter.h"
#include "entropy/lanes.h"
#include "entropy/logistic_math.h"

namespace bspc::entropy {
inline namespace BSPC_LANE_SET {

/// What is known about one binary decision: a number for each source, in the logistic domain
/// (ln of the odds of a 1; 0 says nothing). Each position must keep its meaning from one decision
/// to the next that uses the same weights.
class Evidence {
 public:
  static constexpr unsigned kMaxInputs = 64;
  static constexpr unsigned kMaxCounters = 32;

  void clear() {
    inputs_ = 0;
    counters_ = 0;
  }
  /// Numbers beyond ± 8 count as ± 8.
  void add(float logit) { input_[inputs_++] = clamped(logit, -8, 8); }
  /// A context's own experience; it learns the decision when that is coded.
  void add(Counter& counter) {
    counter_[counters_++] = &counter;
    input_[inputs_++] = counter.evidence();
  }

  /// Fills up the last group of lanes; returns how many entries inputs() has then.
  unsigned pad() {
    while (inputs_ % kLanes != 0) input_[inputs_++] = 0;
    return inputs_;
  }
  const float* inputs() const { return input_.data(); }

  void learn(bool bit, unsigned maxAge) {
    for (unsigned i = 0; i < counters_; ++i) counter_[i]->update(bit, maxAge);
  }

 private:
  unsigned inputs_ = 0;
  unsigned counters_ = 0;
  alignas(32) std::array<float, kMaxInputs> input_{};
  std::array<Counter*, kMaxCounters> counter_{};
};

/// How fast weights learn: start · halfLife / (n + halfLife) + floor after n decisions of a set.
struct MixingRate {
  float start = 0.02F;
  float halfLife = 60;
  float floor = 0.003F;
};

/// One set of weights for each value of a selector, a small class of situations.
class WeightSets {
 public:
  /// `inputs`: most entries of an Evidence that is mixed.
  WeightSets(unsigned sets, unsigned inputs, float weight)
      : stride_(static_cast<unsigned>(wholeLanes(inputs))),
        weights_(std::size_t{sets} * stride_, weight),
        seen_(sets, 0) {}

  void startWeight(unsigned input, float weight) {
    for (std::size_t i = input; i < weights_.size(); i += stride_) weights_[i] = weight;
  }
  float* weights(unsigned set) { return weights_.data() + std::size_t{set} * stride_; }
  float rate(unsigned set, const MixingRate& rate) const {
    return rate.start * rate.halfLife / (static_cast<float>(seen_[set]) + rate.halfLife) +
           rate.floor;
  }
  /// Counts one more decision of a set; returns how many there were before.
  float count(unsigned set) {
    const std::uint32_t before = seen_[set];
    if (before < kMaxSeen) seen_[set] = before + 1;
    return static_cast<float>(before);
  }

 private:
  static constexpr std::uint32_t kMaxSeen = 60000;

  unsigned stride_;
  std::vector<float> weights_;
  std::vector<std::uint32_t> seen_;
};

/// Mixes evidence into one probability, and learns from each decision which sources to believe in
/// which situation (logistic mixing as in Mahoney's PAQ): the logit is a sum of inputs, each
/// weighted by the sum of one weight of each selected set; one step of gradient descent follows.
/// It knows nothing of what the inputs mean.
template <unsigned Selectors>
class LogisticMixer {
 public:
  using Selection = std::array<unsigned, Selectors>;

  /// `sets[i]`: how many values selector i has. The first selector's weights start at `weight`,
  /// the others' at 0.
  LogisticMixer(const Selection& sets, unsigned inputs, float weight, const MixingRate& rate,
                unsigned counterAge)
      : rate_(rate), counterAge_(counterAge) {
    sets_.reserve(Selectors);
    for (unsigned i = 0; i < Selectors; ++i) {
      sets_.emplace_back(sets[i], inputs, i == 0 ? weight : 0.0F);
    }
  }

  /// Another start for the weights of one input in all sets of the first selector.
  void startWeight(unsigned input, float weight) { sets_[0].startWeight(input, weight); }

  /// Codes one decision with a SymbolWriter or SymbolReader.
  template <class Coder>
  bool code(Coder& coder, bool bit, Evidence& evidence, const Selection& selected) {
    const unsigned count = evidence.pad();
    std::array<float*, Selectors> weights{};
    for (unsigned i = 0; i < Selectors; ++i) weights[i] = sets_[i].weights(selected[i]);
    Lanes dot = Lanes(0);
    for (unsigned j = 0; j < count; j += kLanes) {
      Lanes weight = load(weights[0] + j);
      for (unsigned i = 1; i < Selectors; ++i) weight += load(weights[i] + j);
      dot += weight * load(evidence.inputs() + j);
    }
    const float probability = squash(clamped(sum(dot), -11, 11));
    bit = coder.fixedBit(static_cast<std::uint32_t>(clamped(probability * 65536, 4, 65532)), bit);
    const float error = (bit ? 1.0F : 0.0F) - probability;
    const float step = sets_[0].rate(selected[0], rate_) * error;
    for (unsigned i = 0; i < Selectors; ++i) {
      // What the sets share is to be learned once: each further one takes half a step.
      const Lanes scale = Lanes(i == 0 ? step : 0.5F * step);
      for (unsigned j = 0; j < count; j += kLanes) {
        store(weights[i] + j, load(weights[i] + j) + scale * load(evidence.inputs() + j));
      }
    }
    sets_[0].count(selected[0]);
    evidence.learn(bit, counterAge_);
    return bit;
  }

 private:
  std::vector<WeightSets> sets_;
  MixingRate rate_;
  unsigned counterAge_;
};

/// The same in two layers: each selected set makes a logit of its own and learns from its own
/// error; small sets of weights, `Finals` of which are selected, mix these, and the mean of the
/// mixtures is what counts. Two sets more are copies of the first and of
/// the last one that learn at a fifth and at three times the rate. Slower than LogisticMixer, and
/// better where little was seen.
template <unsigned Selectors, unsigned Finals = 1>
class LayeredMixer {
 public:
  using Selection = std::array<unsigned, Selectors>;

  using FinalSelection = std::array<unsigned, Finals>;
  /// How fast the weights of the second layer learn.
  static constexpr MixingRate kFinalRate{0.015F, 10, 0.001F};

  LayeredMixer(const Selection& sets, const FinalSelection& finalSets, unsigned inputs,
               float weight, const MixingRate& rate, unsigned counterAge,
               const MixingRate& finalRate = kFinalRate)
      : rate_(rate), finalRate_(finalRate), counterAge_(counterAge) {
    final_.reserve(Finals);
    for (const unsigned count : finalSets) final_.emplace_back(count, kSets, 1.0F / kSets);
    sets_.reserve(kSets);
    for (unsigned i = 0; i < kSets; ++i) sets_.emplace_back(sets[selectorOf(i)], inputs, weight);
  }

  /// Codes one decision; `finalSets` select the weights of the second layer.
  template <class Coder>
  bool code(Coder& coder, bool bit, Evidence& evidence, const Selection& selected,
            const FinalSelection& finalSets) {
    const unsigned count = evidence.pad();
    std::array<float*, kSets> weights{};
    for (unsigned i = 0; i < kSets; ++i) weights[i] = sets_[i].weights(selected[selectorOf(i)]);
    std::array<Lanes, kLanes> dots{};
    for (unsigned j = 0; j < count; j += kLanes) {
      const Lanes input = load(evidence.inputs() + j);
      for (unsigned i = 0; i < kSets; ++i) dots[i] += load(weights[i] + j) * input;
    }
    const Lanes logits = clamped(sums(dots), -11, 11);
    std::array<float*, Finals> final{};
    alignas(32) std::array<float, kLanes> mixed{};  // the mean after the mixtures
    for (unsigned f = 0; f < Finals; ++f) {
      final[f] = final_[f].weights(finalSets[f]);
      mixed[f] = sum(load(final[f]) * logits);
      mixed[Finals] += mixed[f];
    }
    mixed[Finals] *= 1.0F / Finals;
    const std::array<float, kLanes> chance = valuesOf(squash(clamped(load(mixed.data()), -11, 11)));
    const float probability = chance[Finals];
    bit = coder.fixedBit(static_cast<std::uint32_t>(clamped(probability * 65536, 4, 65532)), bit);
    const float target = bit ? 1.0F : 0.0F;
    for (unsigned f = 0; f < Finals; ++f) {
      const float step = final_[f].rate(finalSets[f], finalRate_) * (target - chance[f]);
      final_[f].count(finalSets[f]);
      store(final[f], load(final[f]) + step * logits);
    }
    const std::array<float, kLanes> steps = valuesOf(ratesOf(selected) * (target - squash(logits)));
    for (unsigned j = 0; j < count; j += kLanes) {
      const Lanes input = load(evidence.inputs() + j);
      for (unsigned i = 0; i < kSets; ++i) {
        store(weights[i] + j, load(weights[i] + j) + Lanes(steps[i]) * input);
      }
    }
    evidence.learn(bit, counterAge_);
    return bit;
  }

 private:
  static constexpr unsigned kSets = Selectors + 2;
  static_assert(kSets <= kLanes && Finals < kLanes, "there is a lane for each set");

  static constexpr unsigned selectorOf(unsigned set) {
    return set < Selectors ? set : set == Selectors ? 0 : Selectors - 1;
  }

  /// How fast the selected sets learn from this decision, which is counted.
  Lanes ratesOf(const Selection& selected) {
    alignas(32) std::array<float, kLanes> seen{};
    alignas(32) std::array<float, kLanes> pace{};
    for (unsigned i = 0; i < kSets; ++i) {
      seen[i] = sets_[i].count(selected[selectorOf(i)]);
      pace[i] = i == Selectors ? 0.2F : i > Selectors ? 3.0F : 1.0F;
    }
    const Lanes rates =
        Lanes(rate_.start * rate_.halfLife) / (load(seen.data()) + rate_.halfLife) + rate_.floor;
    return rates * load(pace.data());
  }

  MixingRate rate_;
  MixingRate finalRate_;
  unsigned counterAge_;
  std::vector<WeightSets> sets_;
  std::vector<WeightSets> final_;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::entropy
