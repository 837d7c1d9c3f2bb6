#include "set_encoder.h"

#include <algorithm>
#include <utility>

#include "lossy_error.h"
#include "parallel.h"

namespace bspc {

void SetEncoder::encode(Span<const GridPoint> points, const std::vector<std::uint64_t>& sourceIndex,
                        const PointSetView* original) {
  sourceIndex_ = &sourceIndex;
  original_ = original;
  // Points are sorted into tiles by 32-bit indices, so sets beyond that are cut into parts first.
  constexpr std::size_t kPart = std::size_t{1} << 31;
  for (std::size_t first = 0; first < points.size(); first += kPart) {
    const std::size_t count = std::min(kPart, points.size() - first);
    encodePart(first, points.subspan(first, count));
  }
}

void SetEncoder::encodePart(std::size_t offset, Span<const GridPoint> points) {
  const tiling::TileCut cut = tiling::cutTiles(points, tilePoints_);
  const auto produce = [&](std::size_t i) {
    if (cut.order.empty()) return encoder_.encode(points, progress_.piece());
    std::vector<GridPoint> tile;
    tile.reserve(cut.firsts[i + 1] - cut.firsts[i]);
    for (std::size_t j = cut.firsts[i]; j < cut.firsts[i + 1]; ++j) {
      tile.push_back(points[cut.order[j]]);
    }
    return encoder_.encode(tile, progress_.piece());
  };
  const auto consume = [&](std::size_t i, FinishedTile tile) {
    std::vector<std::uint64_t> sources;
    if (options_.wantOrder || !tile.decoded.empty()) {
      sources = sourcesOf(cut, i, offset, tile.order);
    }
    finish(std::move(tile), sources);
  };
  OrderedParallel<FinishedTile>(cut.tiles(), threadCount(options_.threads), produce)
      .run(consume, [this] { progress_.report(); });
}

void SetEncoder::finish(FinishedTile tile, const std::vector<std::uint64_t>& sources) {
  for (const Bytes& chunk : tile.chunks) report_.geometryBytes += chunk.size();
  ++report_.tiles;
  if (!tile.decoded.empty() && original_ != nullptr) {
    addLossyError(*original_, sources, tile.decoded, tile.record.lower, report_);
  }
  if (options_.wantOrder) {
    report_.order.insert(report_.order.end(), sources.begin(), sources.end());
  }
  writer_.addTile(std::move(tile.record), std::move(tile.chunks));
}

std::vector<std::uint64_t> SetEncoder::sourcesOf(const tiling::TileCut& cut, std::size_t tile,
                                                 std::size_t offset,
                                                 const std::vector<std::uint32_t>& order) const {
  std::vector<std::uint64_t> sources;
  sources.reserve(order.size());
  for (const std::uint32_t j : order) {
    const std::size_t inPart = cut.firsts[tile] + j;
    const std::size_t index = offset + (cut.order.empty() ? inPart : cut.order[inPart]);
    sources.push_back(sourceIndex_->empty() ? index : (*sourceIndex_)[index]);
  }
  return sources;
}

}  // namespace bspc
