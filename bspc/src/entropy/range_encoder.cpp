#include "entropy/range_encoder.h"

#include <cstddef>

namespace bspc::entropy {

void RangeEncoder::carry() {
  // The code value stays below 1 throughout, so the carry always ends inside what was written.
  std::size_t i = out_.size();
  while (++out_[--i] == 0) {
  }
}

void RangeEncoder::emitWord() {
  for (unsigned shift = 64; shift > 32;) {
    shift -= 8;
    out_.push_back(static_cast<std::uint8_t>(low_ >> shift));
  }
  low_ <<= 32;
}

Bytes RangeEncoder::finish() {
  // Any value in [low, low + range) will do: take the one with the most trailing zeros.
  const std::uint64_t last = low_ + (range_ - 1);
  const bool wraps = last < low_;
  for (unsigned keep = 0; keep <= 64; keep += 8) {
    const std::uint64_t mask = keep == 0 ? 0 : ~std::uint64_t{0} << (64 - keep);
    const std::uint64_t candidate = last & mask;
    if (candidate < low_ && !wraps) continue;
    if (wraps) {
      // 2^64 lies inside the interval: round up to it.
      low_ = 0;
      carry();
    } else {
      low_ = candidate;
    }
    break;
  }
  emitWord();
  emitWord();
  // Only the last eight bytes may go, so that a decoder knows how far it may read past the end.
  for (unsigned i = 0; i < 8 && out_.back() == 0; ++i) out_.pop_back();
  range_ = ~std::uint64_t{0};
  return std::move(out_);
}

}  // namespace bspc::entropy
