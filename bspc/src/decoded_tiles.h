#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "bspc/decoder.h"
#include "bspc/limits.h"

namespace bspc {

/// Gathers decoded tiles into the points of the file, within the limits.
class DecodedTiles {
 public:
  /// `claimed`: how many points the file says there are.
  DecodedTiles(const DecodeLimits& limits, std::uint64_t claimed)
      : limits_(limits), claimed_(claimed) {}

  /// Throws Error(LimitExceeded).
  void append(DecodedPoints&& tile);
  std::uint64_t bytes() const { return bytes_; }
  DecodedPoints take() { return std::move(all_); }

 private:
  void makeRoom(std::size_t more);

  const DecodeLimits& limits_;
  std::uint64_t claimed_;
  DecodedPoints all_;
  std::atomic<std::uint64_t> bytes_{0};  ///< read by other threads
};

/// Keeps `count` points, evenly spaced in the coder's order (so over space as well); the others
/// are counted to the one kept before them.
void thinTo(std::uint64_t count, DecodedPoints& points);

}  // namespace bspc
