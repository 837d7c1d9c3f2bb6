#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "bspc/error.h"
#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Lets the output of a decoder grow as points are decoded, within the limits of the call, and
/// never by what the file claims.
class OutputBudget {
 public:
  explicit OutputBudget(const TileToDecode& tile)
      : claimed_(tile.points),
        maxPoints_(tile.maxPoints),
        maxBytes_(tile.maxBytes),
        bytesPerPoint_(sizeof(GridPoint) + (tile.wantCounts ? 8U : 0U) +
                       (tile.cellLevel ? 8U : 0U)) {}

  /// To be called before `more` points are appended.
  void beforeAppend(DecodedTile& out, std::uint64_t more = 1) const {
    const std::uint64_t size = out.points.size();
    if (more <= out.points.capacity() - size) return;
    if (more > maxPoints_ || size > maxPoints_ - more) {
      throw Error(ErrorCode::LimitExceeded, "the file holds more points than the limit of " +
                                                std::to_string(maxPoints_) +
                                                "; raise the limit if the file is to be trusted");
    }
    const std::uint64_t wished = std::max<std::uint64_t>(2 * size, kFirst);
    const std::uint64_t capacity = std::max(std::min({wished, claimed_, maxPoints_}), size + more);
    // While it grows, the old and the new array stand side by side.
    checkBytes((size + capacity) * bytesPerPoint_);
    out.points.reserve(static_cast<std::size_t>(capacity));
  }

  /// Throws Error(LimitExceeded) if `bytes` are more than the call may allocate.
  void checkBytes(std::uint64_t bytes) const {
    if (bytes <= maxBytes_) return;
    throw Error(ErrorCode::LimitExceeded,
                "decoding needs more memory than the limit of " + std::to_string(maxBytes_) +
                    " bytes; raise the limit if the file is to be trusted");
  }

 private:
  /// A tile of the usual size needs no growing; less than a megabyte is no risk.
  static constexpr std::uint64_t kFirst = 65536;

  std::uint64_t claimed_;
  std::uint64_t maxPoints_;
  std::uint64_t maxBytes_;
  std::uint64_t bytesPerPoint_;
};

}  // namespace bspc::geometry
