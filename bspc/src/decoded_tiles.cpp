#include "decoded_tiles.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "point_selection.h"

namespace bspc {

void DecodedTiles::append(DecodedPoints&& tile) {
  if (all_.points.empty()) {
    all_ = std::move(tile);
    bytes_ = memoryOf(all_);
    return;
  }
  if (all_.points.size() + tile.points.size() > limits_.points) {
    throw Error(ErrorCode::LimitExceeded, "the file holds more points than the limit of " +
                                              std::to_string(limits_.points) +
                                              "; raise the limit if the file is to be trusted");
  }
  // While the arrays grow, the old and the new ones stand side by side.
  if (3 * bytes_ + 2 * memoryOf(tile) > limits_.memoryBytes) {
    throw Error(ErrorCode::LimitExceeded,
                "decoding needs more memory than the limit of " +
                    std::to_string(limits_.memoryBytes) +
                    " bytes; raise the limit if the file is to be trusted");
  }
  makeRoom(tile.points.size());
  appendPoints(all_, std::move(tile));
  bytes_ = memoryOf(all_);
}

/// Grows in long strides towards what the file claims, so that points are seldom moved; but only to
/// a multiple of what was decoded, and to a small part of the memory that is allowed.
void DecodedTiles::makeRoom(std::size_t more) {
  constexpr std::uint64_t kStride = 32;
  constexpr std::uint64_t kPart = 8;
  std::vector<GridPoint>& points = all_.points;
  const std::uint64_t needed = std::uint64_t{points.size()} + more;
  if (needed <= points.capacity()) return;
  const std::uint64_t wish = std::min(claimed_, kStride * needed);
  if (wish > needed && wish <= limits_.memoryBytes / kPart / sizeof(GridPoint)) {
    points.reserve(static_cast<std::size_t>(wish));
  }
}

void thinTo(std::uint64_t count, DecodedPoints& points) {
  const std::uint64_t size = points.points.size();
  if (size <= count) return;
  std::vector<std::size_t> kept;
  if (count > 0) {
    // first(j) = floor(j · size / count), stepped so that no product can overflow.
    const std::uint64_t step = size / count;
    const std::uint64_t part = size % count;
    std::uint64_t first = 0;
    std::uint64_t carried = 0;
    for (std::uint64_t j = 0; j < count; ++j) {
      std::uint64_t next = first + step;
      carried += part;
      if (carried >= count) {
        carried -= count;
        ++next;
      }
      kept.push_back(static_cast<std::size_t>(first));
      if (!points.counts.empty()) {
        std::uint64_t sum = 0;
        for (std::uint64_t i = first; i < next; ++i) sum += points.counts[i];
        points.counts[first] = sum;
      }
      first = next;
    }
  }
  keepPoints(points, kept);
}

}  // namespace bspc
