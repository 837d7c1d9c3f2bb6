#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/symbol_coder.h"

namespace bspc::geometry {

/// Codes how the points of a cell are shared out between its halves: the kd-tree's only symbol
/// ([4] of the paper codes it as one of n + 1 equally likely values; here it is learned).
class KdCountModel {
 public:
  /// What the path to the cell tells about its points.
  struct Context {
    unsigned history = 0;   ///< kHistoryBits bits, newest lowest: one side of an ancestor was empty
    unsigned openBits = 0;  ///< of the axis that is split
  };
  static constexpr unsigned kHistoryBits = 3;

  /// Codes `lower`, the number of the `count` ≥ 2 points that lie in the lower half.
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t lower, std::uint64_t count, Context context) {
    return count <= kSmall ? codeSmall(coder, lower, static_cast<unsigned>(count), context)
                           : codeLarge(coder, lower, count, context);
  }

 private:
  static constexpr unsigned kSmall = 16;  ///< at least kBuckets, so that no bucket is empty
  static constexpr unsigned kHistories = 1U << kHistoryBits;
  static constexpr unsigned kOpenClasses = 4;
  static constexpr unsigned kBuckets = 16;
  static_assert(kSmall >= kBuckets);

  static unsigned openClass(unsigned openBits) {
    return std::min(openBits > 0 ? openBits - 1 : 0U, kOpenClasses - 1);
  }

  /// The smaller half in unary, then which half that is.
  template <class Coder>
  std::uint64_t codeSmall(Coder& coder, std::uint64_t lower, unsigned count, Context context) {
    const unsigned open = openClass(context.openBits);
    auto& model = small_[count - 2][open][context.history];
    const auto wanted = static_cast<unsigned>(std::min<std::uint64_t>(lower, count - lower));
    unsigned less = 0;
    while (less < count / 2 && coder.bit(model[less], less < wanted)) ++less;
    if (2 * less == count) return less;
    const bool lowerHasMore = coder.bit(side_[count - 2][less][open], 2 * lower > count);
    return lowerHasMore ? count - less : less;
  }

  /// Whether a half is empty; if not, a bucket of the share and the rest uniformly.
  template <class Coder>
  std::uint64_t codeLarge(Coder& coder, std::uint64_t lower, std::uint64_t count, Context context) {
    const unsigned size = std::min(entropy::bitLength(count), kSizes) - 1;
    const bool empty = lower == 0 || lower == count;
    if (coder.bit(oneSided_[size][context.history], empty)) {
      return coder.bit(largeSide_[size], lower != 0) ? count : 0;
    }
    // 1 … count − 1, cut into kBuckets ranges that differ by one at most.
    const std::uint64_t values = count - 1;
    const auto bucketStart = [values](std::uint64_t b) { return (b * values) / kBuckets; };
    std::uint64_t bucket = 0;
    if (Coder::kWriting && !empty) {
      bucket = ((lower - 1) * kBuckets) / values;
      while (bucket + 1 < kBuckets && bucketStart(bucket + 1) <= lower - 1) ++bucket;
    }
    bucket = coder.symbol(share_[size], static_cast<unsigned>(bucket));
    const std::uint64_t start = bucketStart(bucket);
    const std::uint64_t last = bucketStart(bucket + 1) - 1 - start;
    return 1 + start +
           coder.uniform(static_cast<std::uint32_t>(lower - 1 - start),
                         static_cast<std::uint32_t>(last));
  }

  static constexpr unsigned kSizes = 33;
  using Unary = std::array<entropy::AdaptiveBit, kSmall / 2>;
  std::array<std::array<std::array<Unary, kHistories>, kOpenClasses>, kSmall - 1> small_{};
  std::array<std::array<std::array<entropy::AdaptiveBit, kOpenClasses>, kSmall / 2>, kSmall - 1>
      side_{};
  std::array<std::array<entropy::AdaptiveBit, kHistories>, kSizes> oneSided_{};
  std::array<entropy::AdaptiveBit, kSizes> largeSide_{};
  std::array<entropy::AdaptiveSymbols<kBuckets>, kSizes> share_{};
};

}  // namespace bspc::geometry
