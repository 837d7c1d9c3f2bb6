#pragma once

#include <array>
#include <cstdint>

namespace bspc::entropy {

namespace detail {

constexpr unsigned kRateAges = 96;

/// 2^16 / (age + 1.6): the first observations count most, and the last rate stays.
constexpr std::array<std::uint16_t, kRateAges> learningRates() {
  std::array<std::uint16_t, kRateAges> rates{};
  for (unsigned age = 0; age < kRateAges; ++age) {
    rates[age] = static_cast<std::uint16_t>(65536U * 10U / (10U * age + 16U));
  }
  return rates;
}

}  // namespace detail

/// Probability of a binary event, learned as it is coded: the average of what was seen while it is
/// young, a moving average later. Integer arithmetic only, the same on encoder and decoder.
class AdaptiveBit {
 public:
  static constexpr unsigned kPrecision = 16;

  /// Probability that the next bit is 1, in units of 2^-16; never 0 and never 2^16.
  std::uint32_t probabilityOfOne() const { return one_; }

  void update(bool bit) {
    const std::uint32_t rate = kRate[age_];
    if (bit) {
      one_ = static_cast<std::uint16_t>(one_ + (((kMax - one_) * rate) >> 16));
    } else {
      one_ = static_cast<std::uint16_t>(one_ - (((one_ - kMin) * rate) >> 16));
    }
    if (age_ + 1U < kRate.size()) ++age_;
  }

 private:
  static constexpr std::uint32_t kMin = 32;
  static constexpr std::uint32_t kMax = 65536 - kMin;
  static constexpr std::array<std::uint16_t, detail::kRateAges> kRate = detail::learningRates();

  std::uint16_t one_ = 32768;
  std::uint8_t age_ = 0;
};

}  // namespace bspc::entropy
