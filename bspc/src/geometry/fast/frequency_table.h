#pragma once

#include <array>
#include <cstdint>

#include "geometry/fast/bit_stream.h"
#include "geometry/fast/value_code.h"

namespace bspc::geometry::fast {

constexpr unsigned kFrequencyBits = 11;
constexpr std::uint32_t kFrequencyTotal = 1U << kFrequencyBits;

using SymbolCounts = std::array<std::uint32_t, kSymbols>;

/// Frequencies of the symbols of an alphabet; they add up to kFrequencyTotal.
class FrequencyTable {
 public:
  /// `weights` in proportion; symbols of weight 0 get frequency 0, others at least 1.
  static FrequencyTable proportionalTo(const SymbolCounts& weights);
  /// Values that fall off geometrically with about this mean (in hundredths) up to `direct`, and
  /// a tail: what is assumed of a table that a tile does not bring along.
  static FrequencyTable geometric(unsigned direct, std::uint32_t meanInHundredths);

  std::uint32_t operator[](unsigned symbol) const { return frequency_[symbol]; }

  /// Bits that symbols of these counts take; infinite if one of them has frequency 0.
  double cost(const SymbolCounts& counts) const;

 private:
  std::array<std::uint16_t, kSymbols> frequency_{};
};

/// Counts rounded to what a stream stores of a table: three significant bits a symbol.
SymbolCounts storedWeights(const SymbolCounts& counts);
void writeWeights(BitWriter& bits, const SymbolCounts& weights);
/// Throws Error(Corrupt) if they cannot be weights of a table.
SymbolCounts readWeights(BitReader& bits);

}  // namespace bspc::geometry::fast
