#include "set_encoder.h"

#include <algorithm>
#include <utility>

#include "lossy_error.h"
#include "parallel.h"

namespace bspc {

namespace {

/// Input indices of a tile's points, in decoded order.
std::vector<std::uint64_t> sourcesOf(const tiling::TileCut& cut, std::size_t tile,
                                     std::size_t offset,
                                     const std::vector<std::uint64_t>& sourceIndex,
                                     const std::vector<std::uint32_t>& order) {
  std::vector<std::uint64_t> sources;
  sources.reserve(order.size());
  for (const std::uint32_t j : order) {
    const std::size_t inPart = cut.firsts[tile] + j;
    const std::size_t index = offset + (cut.order.empty() ? inPart : cut.order[inPart]);
    sources.push_back(sourceIndex.empty() ? index : sourceIndex[index]);
  }
  return sources;
}

}  // namespace

void SetEncoder::encode(Span<const GridPoint> points,
                        const std::vector<std::uint64_t>& sourceIndex) {
  // Points are sorted into tiles by 32-bit indices, so sets beyond that are cut into parts first.
  constexpr std::size_t kPart = std::size_t{1} << 31;
  for (std::size_t first = 0; first < points.size(); first += kPart) {
    const std::size_t count = std::min(kPart, points.size() - first);
    encodePart(first, points.subspan(first, count), sourceIndex);
  }
}

void SetEncoder::encodePart(std::size_t offset, Span<const GridPoint> points,
                            const std::vector<std::uint64_t>& sourceIndex) {
  const tiling::TileCut cut = tiling::cutTiles(points, tilePoints_);
  const auto produce = [&](std::size_t i) {
    if (cut.order.empty()) return encoder_.encode(points, progress_.piece());
    std::vector<GridPoint> tile(cut.firsts[i + 1] - cut.firsts[i]);
    for (std::size_t j = 0; j < tile.size(); ++j) tile[j] = points[cut.order[cut.firsts[i] + j]];
    return encoder_.encode(tile, progress_.piece());
  };
  const auto consume = [&](std::size_t i, FinishedTile tile) {
    for (const Bytes& chunk : tile.chunks) report_.geometryBytes += chunk.size();
    ++report_.tiles;
    const bool moved = original_ != nullptr && !tile.decoded.empty();
    if (options_.wantOrder || moved) {
      const std::vector<std::uint64_t> sources = sourcesOf(cut, i, offset, sourceIndex, tile.order);
      if (moved) addLossyError(*original_, sources, tile.decoded, tile.record.lower, report_);
      if (options_.wantOrder) {
        report_.order.insert(report_.order.end(), sources.begin(), sources.end());
      }
    }
    writer_.addTile(std::move(tile.record), std::move(tile.chunks));
  };
  OrderedParallel<FinishedTile>(cut.tiles(), threadCount(options_.threads), produce)
      .run(consume, [this] { progress_.report(); });
}

}  // namespace bspc
