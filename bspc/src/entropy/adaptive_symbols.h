#pragma once

#include <array>
#include <cstdint>

namespace bspc::entropy {

/// Frequencies of an alphabet of `Size` symbols, learned as they are coded. Integer arithmetic
/// only, the same on encoder and decoder.
template <unsigned Size>
class AdaptiveSymbols {
 public:
  AdaptiveSymbols() {
    frequency_.fill(kIncrement);
    total_ = Size * kIncrement;
  }

  std::uint32_t total() const { return total_; }
  std::uint32_t frequency(unsigned symbol) const { return frequency_[symbol]; }

  /// Sum of the frequencies of the symbols before `symbol`.
  std::uint32_t cumulative(unsigned symbol) const {
    std::uint32_t sum = 0;
    for (unsigned s = 0; s < symbol; ++s) sum += frequency_[s];
    return sum;
  }

  /// The symbol whose range holds `position` < total(), and the start of its range.
  unsigned find(std::uint32_t position, std::uint32_t& start) const {
    start = 0;
    unsigned symbol = 0;
    while (symbol + 1 < Size && start + frequency_[symbol] <= position) {
      start += frequency_[symbol++];
    }
    return symbol;
  }

  void update(unsigned symbol) {
    frequency_[symbol] += kIncrement;
    total_ += kIncrement;
    if (total_ > kLimit) halve();
  }

 private:
  static constexpr std::uint32_t kIncrement = 24;
  static constexpr std::uint32_t kLimit = 1U << 14;
  static_assert(Size * kIncrement < kLimit / 2, "the alphabet is too large for this model");

  void halve() {
    total_ = 0;
    for (std::uint32_t& f : frequency_) {
      f = (f + 1) / 2;
      total_ += f;
    }
  }

  std::array<std::uint32_t, Size> frequency_{};
  std::uint32_t total_ = 0;
};

}  // namespace bspc::entropy
