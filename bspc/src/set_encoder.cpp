#include "set_encoder.h"

#include <algorithm>
#include <utility>

#include "parallel.h"

namespace bspc {

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
    if (options_.wantOrder) appendOrder(cut, i, offset, sourceIndex, tile.order);
    writer_.addTile(std::move(tile.record), std::move(tile.chunks));
  };
  OrderedParallel<FinishedTile>(cut.tiles(), threadCount(options_.threads), produce)
      .run(consume, [this] { progress_.report(); });
}

void SetEncoder::appendOrder(const tiling::TileCut& cut, std::size_t tile, std::size_t offset,
                             const std::vector<std::uint64_t>& sourceIndex,
                             const std::vector<std::uint32_t>& order) {
  for (const std::uint32_t j : order) {
    const std::size_t inPart = cut.firsts[tile] + j;
    const std::size_t index = offset + (cut.order.empty() ? inPart : cut.order[inPart]);
    report_.order.push_back(sourceIndex.empty() ? index : sourceIndex[index]);
  }
}

}  // namespace bspc
