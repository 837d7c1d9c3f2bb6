#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "connectivity/numbers.h"
#include "entropy/adaptive_symbols.h"

namespace bspc::connectivity {

/// Codes how many corners faces have, given the number of a neighbour (0: there is none).
class FaceSizeSymbols {
 public:
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t size, std::uint64_t neighbour) {
    auto& model = model_[classOf(neighbour)][last_];
    const unsigned symbol =
        coder.symbol(model, static_cast<unsigned>(std::min<std::uint64_t>(size, kLarge)));
    size = symbol < kLarge ? symbol : kLarge + codeNumber(coder, size - kLarge);
    last_ = classOf(size);
    return size;
  }

 private:
  static constexpr unsigned kLarge = 11;
  static constexpr unsigned kClasses = 6;

  static unsigned classOf(std::uint64_t size) {
    return size < 3 ? 0 : static_cast<unsigned>(std::min<std::uint64_t>(size - 2, kClasses - 1));
  }

  std::array<std::array<entropy::AdaptiveSymbols<kLarge + 1>, kClasses>, kClasses> model_;
  unsigned last_ = 0;
};

}  // namespace bspc::connectivity
