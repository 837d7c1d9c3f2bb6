#pragma once

#include <array>
#include <cstdint>

#include "entropy/logistic_math.h"

namespace bspc::entropy {
inline namespace BSPC_LANE_SET {

namespace lane_detail {

constexpr unsigned kCounterAges = 256;

/// 2^16 / (age + 1.6)
constexpr std::array<std::uint32_t, kCounterAges> counterRates() {
  std::array<std::uint32_t, kCounterAges> rates{};
  for (std::uint32_t age = 0; age < kCounterAges; ++age) {
    rates[age] = 65536U * 10U / (10U * age + 16U);
  }
  return rates;
}

/// age / (age + 1.5): how much is to be made of what so many observations say.
constexpr std::array<float, kCounterAges> counterConfidences() {
  std::array<float, kCounterAges> confidences{};
  for (unsigned age = 0; age < kCounterAges; ++age) {
    confidences[age] = static_cast<float>(age) / (static_cast<float>(age) + 1.5F);
  }
  return confidences;
}

inline constexpr auto kCounterRate = counterRates();
inline constexpr auto kCounterConfidence = counterConfidences();

}  // namespace lane_detail

/// Probability of a binary event in one context, with the number of times that was seen: the
/// average of what came while it is young, a moving average later. Evidence for a LogisticMixer.
class Counter {
 public:
  /// How many observations at most the average reaches back over.
  static constexpr unsigned kMaxAge = lane_detail::kCounterAges - 1;

  /// ln(p / (1 − p)), drawn to 0 while little was seen.
  float evidence() const {
    return kStretch[state_ >> (32 - kStretchBits)] * lane_detail::kCounterConfidence[age()];
  }

  /// How much is known, 0 to 1: what evidence() is drawn to 0 by.
  float confidence() const { return lane_detail::kCounterConfidence[age()]; }

  /// Probability of a 1 in units of 2^-16, from 32 to 2^16 − 32: for a coder's fixedBit().
  std::uint32_t probabilityOfOne() const {
    const std::uint32_t p = state_ >> 16;
    return p < 32 ? 32 : p > 65536 - 32 ? 65536 - 32 : p;
  }

  void update(bool bit, unsigned maxAge = kMaxAge) {
    const std::uint32_t seen = age();
    const auto probability = static_cast<std::int64_t>(state_ >> kAgeBits);
    const std::int64_t target = bit ? kOne - 1 : 0;
    const std::int64_t step = (target - probability) * lane_detail::kCounterRate[seen];
    // Division, not a shift: it rounds towards 0, the same way on both sides.
    const auto moved = static_cast<std::uint32_t>(probability + step / 65536);
    state_ = (moved << kAgeBits) | (seen < maxAge ? seen + 1 : seen);
  }

 private:
  static constexpr unsigned kAgeBits = 8;
  static constexpr std::int64_t kOne = std::int64_t{1} << (32 - kAgeBits);

  std::uint32_t age() const { return state_ & ((1U << kAgeBits) - 1); }

  std::uint32_t state_ = 1U << 31;  ///< probability of a 1 in the upper 24 bits, age in the lower 8
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::entropy
