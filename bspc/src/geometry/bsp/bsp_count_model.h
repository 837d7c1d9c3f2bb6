#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/gaussian_symbols.h"
#include "entropy/symbol_coder.h"

namespace bspc::geometry {

/// Codes how many of a cell's points lie in front of its plane.
class BspCountModel {
 public:
  static constexpr unsigned kHistoryBits = 1;

  /// `front` of `count` ≥ 2 points. `history`: newest lowest, 1 for an ancestor whose cut left a
  /// side without points.
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t front, std::uint64_t count, unsigned history) {
    if (count <= kSmall) {
      entropy::GaussianSymbols& model = small_[history][count - 2];
      if (model.empty()) model.start(static_cast<unsigned>(count) + 1);
      return coder.symbol(model, static_cast<unsigned>(front));
    }
    entropy::GaussianSymbols& model = large_[entropy::bitLength(count) - 1];
    if (model.empty()) model.start(kBins);
    // Bin b holds ⌈b (n + 1) / kBins⌉ up to ⌈(b + 1) (n + 1) / kBins⌉ − 1.
    const auto bin = coder.symbol(model, static_cast<unsigned>(front * kBins / (count + 1)));
    const auto start = [count](std::uint64_t b) { return (b * (count + 1) + kBins - 1) / kBins; };
    const std::uint64_t first = start(bin);
    const std::uint64_t last = start(std::uint64_t{bin} + 1) - 1;
    return first + coder.uniform(static_cast<std::uint32_t>(front - first),
                                 static_cast<std::uint32_t>(last - first));
  }

 private:
  static constexpr unsigned kSmall = 64;
  static constexpr unsigned kBins = 64;
  std::array<std::array<entropy::GaussianSymbols, kSmall - 1>, 1U << kHistoryBits> small_;
  std::array<entropy::GaussianSymbols, 33> large_;
};

}  // namespace bspc::geometry
