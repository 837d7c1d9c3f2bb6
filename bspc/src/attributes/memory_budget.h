#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "bspc/error.h"

namespace bspc::attributes {

/// What a decoder may still allocate.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : limit_(bytes), left_(bytes) {}
  static MemoryBudget unlimited() {
    return MemoryBudget(std::numeric_limits<std::uint64_t>::max());
  }

  /// To be called before `count` things of `bytes` each are allocated; throws
  /// Error(LimitExceeded).
  void take(std::uint64_t count, std::uint64_t bytes = 1) {
    if (bytes > 0 && count > left_ / bytes) {
      throw Error(ErrorCode::LimitExceeded,
                  "decoding arrays needs more memory than the limit of " + std::to_string(limit_) +
                      " bytes; raise the limit if the file is to be trusted");
    }
    left_ -= count * bytes;
  }

  std::uint64_t left() const { return left_; }

 private:
  std::uint64_t limit_;
  std::uint64_t left_;
};

}  // namespace bspc::attributes
