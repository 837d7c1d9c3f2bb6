#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"

namespace bspc::attributes {

/// Size classes of two an octave: 0, 1, 2, 3 for themselves, then 4 for 4 and 5, 5 for 6 and 7, …
constexpr unsigned halfOctave(std::uint64_t v) {
  if (v < 4) return static_cast<unsigned>(v);
  const unsigned length = entropy::bitLength(v);
  return 2 * (length - 1) + static_cast<unsigned>((v >> (length - 2)) & 1);
}

/// What is known about a residual before it is coded.
struct ResidualContext {
  unsigned slot = 0;      ///< the component, as far as components have models of their own
  unsigned expected = 0;  ///< halfOctave of twice the mean size of the neighbours' residuals: at
                          ///< most twice their bits
  unsigned surprise = 0;  ///< how the component before compared with what was expected: 1 … 7, or 0
  unsigned signs = 0;  ///< of the nearest neighbour's residual and of the component before: 0 … 8
};

/// Components with models of their own; further ones share the last.
constexpr unsigned kSlots = 4;

/// Codes residuals of `bits` bits, modulo 2^bits: the bit length through a binary tree, the sign,
/// three bits behind the leading one as learned, the rest raw.
template <class Coder>
class ResidualModels {
 public:
  ResidualModels(unsigned bits, std::uint32_t components)
      : bits_(bits),
        treeBits_(entropy::bitLength(bits)),
        lengths_((std::size_t{slots(components)} * (2 * bits + 1) * kSurprises) << treeBits_),
        mantissas_(std::size_t{slots(components)} * (bits + 1)),
        signs_(std::size_t{slots(components)} * kSignContexts * kSignLengths) {}

  /// The size of a residual (up to 2^(bits − 1)) and whether it is negative.
  struct Residual {
    std::uint64_t size = 0;
    bool negative = false;
  };

  Residual code(Coder& coder, Residual residual, const ResidualContext& context) {
    const unsigned length = codeLength(coder, entropy::bitLength(residual.size), context);
    if (length == 0) return {};
    residual.size = codeMantissa(coder, residual.size, length, context.slot);
    // Contexts have room for what modulo 2^bits is needed, and no more.
    if (residual.size > std::uint64_t{1} << (bits_ - 1)) {
      throw Error(ErrorCode::Corrupt, "a residual of an array is beyond half of its range");
    }
    // Contexts of later residuals follow from this one, and have room for what can be.
    if (residual.size > std::uint64_t{1} << (bits_ - 1)) {
      throw Error(ErrorCode::Corrupt,
                  "a residual of an array is greater than half the range of its "
                  "numbers: the file is damaged");
    }
    const std::size_t sign =
        (std::size_t{context.slot} * kSignContexts + context.signs) * kSignLengths +
        std::min(length, kSignLengths) - 1;
    residual.negative = coder.bit(signs_[sign], residual.negative);
    return residual;
  }

  static constexpr unsigned kSurprises = 8;

 private:
  static constexpr unsigned kSignContexts = 9;
  static constexpr unsigned kSignLengths = 3;
  static constexpr unsigned kModelledBits = 3;
  using Mantissa = std::array<entropy::AdaptiveBit, 1U << kModelledBits>;

  static unsigned slots(std::uint32_t components) { return std::min(components, kSlots); }

  unsigned codeLength(Coder& coder, unsigned length, const ResidualContext& context) {
    const std::size_t tree =
        (std::size_t{context.slot} * (2 * bits_ + 1) + context.expected) * kSurprises +
        context.surprise;
    entropy::AdaptiveBit* models = lengths_.data() + (tree << treeBits_);
    unsigned node = 1;
    for (unsigned bit = treeBits_; bit-- > 0;) {
      node = 2 * node + (coder.bit(models[node], ((length >> bit) & 1) != 0) ? 1U : 0U);
    }
    const unsigned coded = node - (1U << treeBits_);
    if (coded > bits_) {
      throw Error(ErrorCode::Corrupt, "a residual of an array has " + std::to_string(coded) +
                                          " bits, more than its numbers: the file is damaged");
    }
    return coded;
  }

  std::uint64_t codeMantissa(Coder& coder, std::uint64_t size, unsigned length, unsigned slot) {
    if (length == 0) return 0;
    Mantissa& models = mantissas_[std::size_t{slot} * (bits_ + 1) + length];
    const unsigned below = length - 1;
    const unsigned modelled = below < kModelledBits ? below : kModelledBits;
    unsigned node = 1;
    for (unsigned i = 1; i <= modelled; ++i) {
      const bool bit = ((size >> (below - i)) & 1) != 0;
      node = 2 * node + (coder.bit(models[node], bit) ? 1U : 0U);
    }
    const unsigned raw = below - modelled;
    if (raw == 0) return node;
    const std::uint64_t mask = (std::uint64_t{1} << raw) - 1;
    return (std::uint64_t{node} << raw) | coder.wide(size & mask, raw);
  }

  unsigned bits_;
  unsigned treeBits_;
  std::vector<entropy::AdaptiveBit> lengths_;
  std::vector<Mantissa> mantissas_;
  std::vector<entropy::AdaptiveBit> signs_;
};

}  // namespace bspc::attributes
