#include "decoded_tiles.h"

#include <algorithm>
#include <string>

#include "bspc/error.h"

namespace bspc {

namespace {

template <class T>
void appendTo(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void DecodedTiles::append(DecodedPoints&& tile) {
  if (all_.points.empty()) {
    all_ = std::move(tile);
    bytes_ = all_.points.capacity() * bytesPerPoint_;
    return;
  }
  if (all_.points.size() + tile.points.size() > limits_.points) {
    throw Error(ErrorCode::LimitExceeded, "the file holds more points than the limit of " +
                                              std::to_string(limits_.points) +
                                              "; raise the limit if the file is to be trusted");
  }
  // While the arrays grow, the old and the new ones stand side by side.
  const std::uint64_t most = 3 * all_.points.size() + 2 * tile.points.size();
  if (most * bytesPerPoint_ > limits_.memoryBytes) {
    throw Error(ErrorCode::LimitExceeded,
                "decoding needs more memory than the limit of " +
                    std::to_string(limits_.memoryBytes) +
                    " bytes; raise the limit if the file is to be trusted");
  }
  appendTo(all_.points, tile.points);
  appendTo(all_.counts, tile.counts);
  appendTo(all_.cellIds, tile.cellIds);
  bytes_ = all_.points.capacity() * bytesPerPoint_;
}

void thinTo(std::uint64_t count, DecodedPoints& points) {
  const std::uint64_t size = points.points.size();
  if (size <= count) return;
  if (count == 0) {
    points.points.clear();
    points.counts.clear();
    points.cellIds.clear();
    return;
  }
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
    points.points[j] = points.points[first];
    if (!points.cellIds.empty()) points.cellIds[j] = points.cellIds[first];
    if (!points.counts.empty()) {
      std::uint64_t sum = 0;
      for (std::uint64_t i = first; i < next; ++i) sum += points.counts[i];
      points.counts[j] = sum;
    }
    first = next;
  }
  points.points.resize(static_cast<std::size_t>(count));
  if (!points.counts.empty()) points.counts.resize(static_cast<std::size_t>(count));
  if (!points.cellIds.empty()) points.cellIds.resize(static_cast<std::size_t>(count));
}

}  // namespace bspc
