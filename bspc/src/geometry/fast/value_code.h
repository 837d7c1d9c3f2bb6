#pragma once

#include <array>
#include <cstdint>

#include "entropy/symbol_coder.h"

namespace bspc::geometry::fast {

constexpr unsigned kSymbols = 128;  ///< size of every alphabet

/// How unsigned values become symbols and extra bits: values below `direct` are symbols of their
/// own; from there on a symbol says the length of the value and its `mantissa` leading bits.
class ValueCode {
 public:
  constexpr ValueCode(unsigned direct, unsigned mantissa) : direct_(direct), mantissa_(mantissa) {
    for (unsigned s = 0; s < kSymbols; ++s) {
      if (s < direct + (1U << mantissa)) {
        base_[s] = s;
        continue;
      }
      const unsigned q = s - direct;
      const unsigned extra = (q >> mantissa) - 1;
      const std::uint64_t leading = (1U << mantissa) | (q & ((1U << mantissa) - 1));
      base_[s] = direct + (leading << extra);
      extra_[s] = static_cast<std::uint8_t>(extra);
    }
  }

  constexpr unsigned direct() const { return direct_; }
  /// Least value of a symbol, and how many extra bits tell its values apart.
  constexpr std::uint64_t base(unsigned symbol) const { return base_[symbol]; }
  constexpr unsigned extraBits(unsigned symbol) const { return extra_[symbol]; }

  unsigned symbolOf(std::uint64_t value) const {
    if (value < direct_ + (std::uint64_t{1} << mantissa_)) return static_cast<unsigned>(value);
    const std::uint64_t rest = value - direct_;
    const unsigned extra = entropy::bitLength(rest) - 1 - mantissa_;
    return direct_ + ((extra + 1) << mantissa_) +
           static_cast<unsigned>((rest >> extra) & ((1U << mantissa_) - 1));
  }

 private:
  unsigned direct_;
  unsigned mantissa_;
  std::array<std::uint64_t, kSymbols> base_{};
  std::array<std::uint8_t, kSymbols> extra_{};
};

inline constexpr ValueCode kGapCode(24, 1);
inline constexpr ValueCode kResidualCode(32, 1);
inline constexpr ValueCode kFieldCode(0, 2);
inline constexpr ValueCode kStepCode(40, 1);  ///< between values of a remapped axis

/// A class says of what size the values of a chunk are: 2^(class / 2). The first classes have a
/// frequency table each; larger ones have two in turn and strip low bits, which are random.
class ValueClasses {
 public:
  constexpr ValueClasses(unsigned plain, unsigned last) : plain_(plain), last_(last) {}

  constexpr unsigned last() const { return last_; }
  constexpr unsigned tables() const { return plain_ + 2; }
  constexpr unsigned table(unsigned cls) const { return cls < plain_ ? cls : plain_ + (cls & 1); }
  constexpr unsigned shift(unsigned cls) const {
    return cls < plain_ ? 0 : (cls >> 1) - (plain_ / 2 - 1);
  }

 private:
  unsigned plain_;
  unsigned last_;
};

inline constexpr ValueClasses kGapClasses(8, 98);
inline constexpr ValueClasses kResidualClasses(10, 57);

constexpr std::uint64_t zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0);
}
constexpr std::int64_t unzigzag(std::uint64_t code) {
  return static_cast<std::int64_t>((code >> 1) ^ (~(code & 1) + 1));
}
constexpr std::uint32_t zigzag32(std::uint32_t difference) {
  return (difference << 1) ^ (~(difference >> 31) + 1);
}
constexpr std::uint32_t unzigzag32(std::uint32_t code) { return (code >> 1) ^ (~(code & 1) + 1); }

}  // namespace bspc::geometry::fast
