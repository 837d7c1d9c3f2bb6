#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "geometry/geometry_method.h"
#include "saturating.h"

namespace bspc::geometry {

/// Lets the output of a decoder grow as points are decoded, within the limits of the call, and
/// never by what the file claims.
class OutputBudget {
 public:
  explicit OutputBudget(const TileToDecode& tile)
      : claimed_(tile.points),
        maxPoints_(tile.maxPoints),
        maxBytes_(tile.maxBytes),
        wantCounts_(tile.wantCounts),
        wantCells_(tile.cellLevel.has_value()),
        bytesPerPoint_(sizeof(GridPoint) + (wantCounts_ ? 8U : 0U) + (wantCells_ ? 8U : 0U)) {}

  /// To be called before `more` points are appended. Throws Error(LimitExceeded), or Corrupt for
  /// more points than the tile claims; so a great many equal ones are refused before the first.
  void beforeAppend(DecodedTile& out, std::uint64_t more = 1) const {
    const std::uint64_t size = out.points.size();
    if (more > claimed_ || size > claimed_ - more) {
      throw Error(ErrorCode::Corrupt,
                  "a tile has more points than the " + std::to_string(claimed_) + " that it says");
    }
    if (more <= out.points.capacity() - size) return;
    if (more > maxPoints_ || size > maxPoints_ - more) {
      throw Error(ErrorCode::LimitExceeded, "the file holds more points than the limit of " +
                                                std::to_string(maxPoints_) +
                                                "; raise the limit if the file is to be trusted");
    }
    const std::uint64_t wished = std::max<std::uint64_t>(2 * out.points.capacity(), kFirst);
    const std::uint64_t capacity = std::max(std::min({wished, claimed_, maxPoints_}), size + more);
    // While it grows, the old and the new array stand side by side.
    checkBytes(size + capacity <= maxBytes_ / bytesPerPoint_
                   ? held_ + (size + capacity) * bytesPerPoint_
                   : std::numeric_limits<std::uint64_t>::max());
    out.points.reserve(static_cast<std::size_t>(capacity));
    if (wantCounts_) out.counts.reserve(static_cast<std::size_t>(capacity));
    if (wantCells_) out.cellIds.reserve(static_cast<std::size_t>(capacity));
  }

  /// Says that from now on `bytes` are allocated beside the output: cells and the like. Throws
  /// Error(LimitExceeded) if these and the output are more than the call may allocate.
  void hold(const DecodedTile& out, std::uint64_t bytes) {
    checkBytes(saturatingAdd(bytes, out.points.capacity() * bytesPerPoint_));
    held_ = bytes;
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
  bool wantCounts_;
  bool wantCells_;
  std::uint64_t bytesPerPoint_;
  std::uint64_t held_ = 0;
};

}  // namespace bspc::geometry
