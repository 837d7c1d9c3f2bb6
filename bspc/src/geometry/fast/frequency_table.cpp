#include "geometry/fast/frequency_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bspc::geometry::fast {

namespace {

constexpr unsigned kMantissaBits = 2;    ///< stored of a weight behind its leading bit
constexpr unsigned kMaxWeightBits = 12;  ///< of kFrequencyTotal itself
constexpr unsigned kFirstLength = 6;     ///< what the first length is told relative to

/// Bits that a symbol of each frequency takes.
using SymbolBits = std::array<double, kFrequencyTotal + 1>;

SymbolBits bitsByFrequency() {
  SymbolBits bits{};
  for (std::size_t f = 1; f < bits.size(); ++f) {
    bits[f] = kFrequencyBits - std::log2(static_cast<double>(f));
  }
  return bits;
}

}  // namespace

FrequencyTable FrequencyTable::proportionalTo(const SymbolCounts& weights) {
  FrequencyTable table;
  std::uint64_t total = 0;
  for (const std::uint32_t w : weights) total += w;
  if (total == 0) {
    table.frequency_[0] = kFrequencyTotal;
    return table;
  }
  std::int64_t missing = kFrequencyTotal;
  for (unsigned s = 0; s < kSymbols; ++s) {
    if (weights[s] == 0) continue;
    const std::uint64_t share = (std::uint64_t{weights[s]} * kFrequencyTotal + total / 2) / total;
    table.frequency_[s] = static_cast<std::uint16_t>(std::max<std::uint64_t>(share, 1));
    missing -= table.frequency_[s];
  }
  // What rounding left over is given to, or taken from, the most frequent symbols.
  while (missing != 0) {
    auto& most = *std::max_element(table.frequency_.begin(), table.frequency_.end());
    const std::int64_t step = std::min<std::int64_t>(std::abs(missing), std::max(most >> 4, 1));
    const std::int64_t change = missing > 0 ? step : -step;
    most = static_cast<std::uint16_t>(most + change);
    missing -= change;
  }
  return table;
}

FrequencyTable FrequencyTable::geometric(unsigned direct, std::uint32_t meanInHundredths) {
  SymbolCounts weights{};
  std::uint64_t weight = 1U << 20;
  for (unsigned s = 0; s < direct; ++s) {
    weights[s] = static_cast<std::uint32_t>(weight) + 8;
    weight = weight * meanInHundredths / (meanInHundredths + 100);
  }
  std::uint64_t tail = 4 * weight + 2000;
  for (unsigned s = direct; s < kSymbols; ++s) {
    weights[s] = static_cast<std::uint32_t>(tail >> 8) + 2;
    tail = tail * 7 / 10;
  }
  return proportionalTo(weights);
}

double FrequencyTable::cost(const SymbolCounts& counts) const {
  static const SymbolBits symbolBits = bitsByFrequency();
  double bits = 0;
  for (unsigned s = 0; s < kSymbols; ++s) {
    if (counts[s] == 0) continue;
    if (frequency_[s] == 0) return std::numeric_limits<double>::infinity();
    bits += counts[s] * symbolBits[frequency_[s]];
  }
  return bits;
}

SymbolCounts storedWeights(const SymbolCounts& counts) {
  std::uint64_t total = 0;
  for (const std::uint32_t c : counts) total += c;
  SymbolCounts weights{};
  if (total == 0) return weights;
  for (unsigned s = 0; s < kSymbols; ++s) {
    if (counts[s] == 0) continue;
    const std::uint64_t share = (std::uint64_t{counts[s]} * kFrequencyTotal + total / 2) / total;
    auto weight = static_cast<std::uint32_t>(std::max<std::uint64_t>(share, 1));
    const unsigned length = entropy::bitLength(weight);
    if (length > kMantissaBits + 1) {
      const unsigned drop = length - kMantissaBits - 1;
      weight = ((weight + (1U << (drop - 1))) >> drop) << drop;
    }
    weights[s] = weight;
  }
  return weights;
}

void writeWeights(BitWriter& bits, const SymbolCounts& weights) {
  unsigned last = kSymbols - 1;
  while (last > 0 && weights[last] == 0) --last;
  bits.put(last, 7);
  int previous = kFirstLength;
  for (unsigned s = 0; s <= last; ++s) {
    const unsigned length = entropy::bitLength(weights[s]);
    // The change of length in unary: ones, and a zero that ends them.
    const std::uint64_t change = zigzag(static_cast<int>(length) - previous);
    bits.put(lowBits(static_cast<unsigned>(change)), static_cast<unsigned>(change) + 1);
    if (length > 1) {
      const unsigned kept = std::min(length - 1, kMantissaBits);
      bits.put((weights[s] >> (length - 1 - kept)) & lowBits(kept), kept);
    }
    previous = static_cast<int>(length);
  }
}

SymbolCounts readWeights(BitReader& bits) {
  SymbolCounts weights{};
  const auto last = static_cast<unsigned>(bits.get(7));
  std::int64_t length = kFirstLength;
  for (unsigned s = 0; s <= last; ++s) {
    std::uint64_t change = 0;
    while (bits.get(1) != 0) ++change;
    length += unzigzag(change);
    if (length < 0 || length > kMaxWeightBits) {
      throw Error(ErrorCode::Corrupt, "a frequency table has a weight of " +
                                          std::to_string(length) + " bits: the file is damaged");
    }
    if (length == 0) continue;
    const unsigned kept = std::min(static_cast<unsigned>(length) - 1, kMantissaBits);
    const std::uint64_t leading = (std::uint64_t{1} << kept) | (kept > 0 ? bits.get(kept) : 0);
    weights[s] = static_cast<std::uint32_t>(leading << (length - 1 - kept));
  }
  return weights;
}

}  // namespace bspc::geometry::fast
