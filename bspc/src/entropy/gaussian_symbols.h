#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace bspc::entropy {

/// Frequencies of an alphabet whose size is known at run time only. They start from a Gaussian
/// around the middle of the alphabet, as the paper has it, and are learned as symbols are coded.
/// Integer arithmetic only, the same on encoder and decoder.
class GaussianSymbols {
 public:
  static constexpr unsigned kMaxSize = 256;

  bool empty() const { return frequency_.empty(); }

  /// `size` symbols, 1 … kMaxSize; symbol i stands at 2 i / (size − 1) − 1 on [−1, 1], where the
  /// Gaussian's standard deviation is ½.
  void start(unsigned size) {
    frequency_.resize(size);
    total_ = 0;
    for (unsigned i = 0; i < size; ++i) {
      const unsigned twice = 2 * i;
      const unsigned from = twice < size - 1 ? size - 1 - twice : twice - (size - 1);
      const unsigned place = size > 1 ? from * kGaussSteps / (size - 1) : 0;
      frequency_[i] = static_cast<std::uint16_t>(kFlat + kGauss[place] / kGaussShare);
      total_ += frequency_[i];
    }
  }

  std::uint32_t total() const { return total_; }
  std::uint32_t frequency(unsigned symbol) const { return frequency_[symbol]; }
  std::uint32_t cumulative(unsigned symbol) const {
    std::uint32_t sum = 0;
    for (unsigned s = 0; s < symbol; ++s) sum += frequency_[s];
    return sum;
  }
  unsigned find(std::uint32_t position, std::uint32_t& start) const {
    start = 0;
    unsigned symbol = 0;
    while (symbol + 1 < frequency_.size() && start + frequency_[symbol] <= position) {
      start += frequency_[symbol++];
    }
    return symbol;
  }
  void update(unsigned symbol) {
    frequency_[symbol] = static_cast<std::uint16_t>(frequency_[symbol] + kIncrement);
    total_ += kIncrement;
    if (total_ > kLimit) halve();
  }

 private:
  /// 1024 exp(−2 (k / 32)²), rounded: half a Gaussian of standard deviation ½.
  static constexpr unsigned kGaussSteps = 32;
  static constexpr std::array<std::uint16_t, kGaussSteps + 1> kGauss{
      1024, 1022, 1016, 1006, 992, 975, 954, 931, 904, 874, 842, 808, 773, 736, 698, 660, 621,
      582,  544,  506,  469,  433, 398, 364, 332, 302, 273, 247, 221, 198, 177, 157, 139};
  static constexpr unsigned kGaussShare = 128;
  static constexpr unsigned kFlat = 10;
  static constexpr unsigned kIncrement = 16;
  static constexpr std::uint32_t kLimit = 1U << 15;

  void halve() {
    total_ = 0;
    for (std::uint16_t& f : frequency_) {
      f = static_cast<std::uint16_t>((f + 1) / 2);
      total_ += f;
    }
  }

  std::vector<std::uint16_t> frequency_;
  std::uint32_t total_ = 0;
};

}  // namespace bspc::entropy
