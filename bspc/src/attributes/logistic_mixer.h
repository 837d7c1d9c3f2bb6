#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace bspc::attributes {

/// The logistic function and its inverse in integers: a probability in units of 2^-16 and its
/// logarithmic odds in units of 1/256, between −2047 and 2047.
class LogisticTables {
 public:
  static const LogisticTables& instance();

  static constexpr int kMaxOdds = 2047;

  std::uint32_t probability(int odds) const {
    const int place = std::clamp(odds, -kMaxOdds, kMaxOdds) + kMaxOdds;
    return squash_[static_cast<std::size_t>(place)];
  }
  /// Of a probability; its upper twelve bits count.
  int odds(std::uint32_t probability) const { return stretch_[probability >> 4]; }

 private:
  LogisticTables();

  std::array<std::uint16_t, 2 * kMaxOdds + 1> squash_{};
  std::array<std::int16_t, 4096> stretch_{};
};

namespace detail {

constexpr unsigned kContextAges = 161;

/// 2^16 / (age + 1.6), as entropy::AdaptiveBit has it, but for longer.
constexpr std::array<std::uint16_t, kContextAges> contextRates() {
  std::array<std::uint16_t, kContextAges> rates{};
  for (unsigned age = 0; age < kContextAges; ++age) {
    rates[age] = static_cast<std::uint16_t>(65536U * 10U / (10U * age + 16U));
  }
  return rates;
}

}  // namespace detail

/// Probability of a bit in one context, learned more slowly than entropy::AdaptiveBit's for a
/// longer time: it is an input of a mixer.
class ContextBit {
 public:
  std::uint32_t probabilityOfOne() const { return one_; }

  void update(bool bit) {
    const std::uint32_t rate = kRate[age_];
    if (bit) {
      one_ = static_cast<std::uint16_t>(one_ + (((65535U - one_) * rate) >> 16));
    } else {
      one_ = static_cast<std::uint16_t>(one_ - ((one_ * rate) >> 16));
    }
    if (age_ + 1U < kRate.size()) ++age_;
  }

 private:
  static constexpr auto kRate = detail::contextRates();

  std::uint16_t one_ = 32768;
  std::uint16_t age_ = 0;
};

/// Weights of one set of `Inputs` predictions, in units of 2^-16.
template <unsigned Inputs>
struct MixerWeights {
  std::array<std::int32_t, Inputs> weights{};

  explicit MixerWeights(std::int32_t start = 0) { weights.fill(start); }
};

/// Codes a bit with the mean of several contexts' predictions in the logistic domain, weighted by
/// what proved right, and lets all of them learn from it.
template <unsigned Inputs, class Coder>
bool codeMixed(Coder& coder, const LogisticTables& tables,
               const std::array<ContextBit*, Inputs>& contexts, MixerWeights<Inputs>& mixer,
               bool bit) {
  constexpr std::int32_t kGreatestWeight = 1 << 22;
  std::array<int, Inputs> odds;
  std::int64_t sum = 0;
  for (unsigned i = 0; i < Inputs; ++i) {
    odds[i] = tables.odds(contexts[i]->probabilityOfOne());
    sum += std::int64_t{mixer.weights[i]} * odds[i];
  }
  const auto mixed = static_cast<int>(
      std::clamp<std::int64_t>(sum >> 16, -LogisticTables::kMaxOdds, LogisticTables::kMaxOdds));
  const std::uint32_t probability = tables.probability(mixed);
  bit = coder.fixedBit(probability, bit);
  const int error = (bit ? 65535 : 0) - static_cast<int>(probability);
  for (unsigned i = 0; i < Inputs; ++i) {
    const std::int32_t step = (odds[i] * error + (1 << 13)) >> 14;
    mixer.weights[i] = std::clamp(mixer.weights[i] + step, -kGreatestWeight, kGreatestWeight);
    contexts[i]->update(bit);
  }
  return bit;
}

}  // namespace bspc::attributes
