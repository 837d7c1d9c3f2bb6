#include "set_encoder.h"

#include <algorithm>
#include <utility>

#include "arrays/order_trial.h"
#include "lossy_error.h"
#include "parallel.h"

namespace bspc {

void SetEncoder::encode(Span<const GridPoint> points, const std::vector<std::uint64_t>& sourceIndex,
                        const PointSetView* original) {
  sourceIndex_ = &sourceIndex;
  original_ = original;
  considerOrder(points);
  // Points are sorted into tiles by 32-bit indices, so sets beyond that are cut into parts first.
  constexpr std::size_t kPart = std::size_t{1} << 31;
  for (std::size_t first = 0; first < points.size(); first += kPart) {
    const std::size_t count = std::min(kPart, points.size() - first);
    encodePart(first, points.subspan(first, count));
  }
}

void SetEncoder::considerOrder(Span<const GridPoint> points) {
  constexpr unsigned kQuickest = 1;
  const bool named = arrays_.source().size() > arrays_.source().hidden();
  if (!named || arrays_.keepsOrder() || arrays_.effort() <= kQuickest) return;
  arrays_.storeOrder(storedOrderPays(points, *sourceIndex_, arrays_.source(), arrays_.effort()));
}

void SetEncoder::encodePart(std::size_t offset, Span<const GridPoint> points) {
  const tiling::TileCut cut = this->cut(points);
  const auto produce = [&](std::size_t i) { return encodeTile(cut, i, offset, points); };
  const auto consume = [&](std::size_t /*i*/, FinishedTile tile) { finish(std::move(tile)); };
  OrderedParallel<FinishedTile>(cut.tiles(), threadCount(options_.threads), produce)
      .run(consume, [this] { progress_.report(); });
}

tiling::TileCut SetEncoder::cut(Span<const GridPoint> points) const {
  if (!options_.keepOrder) return tiling::cutTiles(points, tilePoints_);
  tiling::TileCut ranges;  // of the input, without an order: the points stay where they are
  for (std::size_t first = 0; first < points.size(); first += tilePoints_) {
    ranges.firsts.push_back(first);
  }
  ranges.firsts.push_back(points.size());
  return ranges;
}

FinishedTile SetEncoder::encodeTile(const tiling::TileCut& cut, std::size_t tile,
                                    std::size_t offset, Span<const GridPoint> points) const {
  const std::vector<std::uint64_t> sources =
      needsSources() ? sourcesOf(cut, tile, offset) : std::vector<std::uint64_t>();
  const std::size_t first = cut.firsts[tile];
  const std::size_t count = cut.firsts[tile + 1] - first;
  if (cut.order.empty()) {
    return encoder_.encode(points.subspan(first, count), sources, progress_.piece());
  }
  std::vector<GridPoint> own;
  own.resize(count);
  constexpr std::size_t kAhead = 96;  // points that are fetched while others are copied
  for (std::size_t i = 0; i < count; ++i) {
    __builtin_prefetch(&points[cut.order[first + std::min(i + kAhead, count - 1)]]);
    own[i] = points[cut.order[first + i]];
  }
  return encoder_.encode(own, sources, progress_.piece());
}

void SetEncoder::finish(FinishedTile tile) {
  report_.geometryBytes += tile.geometryBytes;
  report_.orderBytes += tile.orderBytes;
  const std::size_t hidden = arrays_.source().hidden();
  for (std::size_t a = 0; a < tile.arrayBytes.size(); ++a) {
    if (a < hidden) {
      report_.geometryBytes += tile.arrayBytes[a];
      continue;
    }
    ArrayReport& array = report_.arrays[a - hidden];
    array.bytes += tile.arrayBytes[a];
    array.greatestError = std::max(array.greatestError, tile.arrayErrors[a]);
  }
  ++report_.tiles;
  if (!tile.decoded.empty() && original_ != nullptr) {
    addLossyError(*original_, tile.sources, tile.decoded, tile.record.lower, report_);
  }
  if (options_.wantOrder) {
    // Decoders put points back into the order of the input.
    if (options_.keepOrder) std::sort(tile.sources.begin(), tile.sources.end());
    report_.order.insert(report_.order.end(), tile.sources.begin(), tile.sources.end());
  }
  faces_ = std::move(tile.faces);
  writer_.addTile(std::move(tile.record), std::move(tile.chunks));
}

bool SetEncoder::needsSources() const {
  return options_.wantOrder || arrays_.hasWork() || options_.stopPoints > 0 || options_.stopLevel;
}

std::vector<std::uint64_t> SetEncoder::sourcesOf(const tiling::TileCut& cut, std::size_t tile,
                                                 std::size_t offset) const {
  std::vector<std::uint64_t> sources;
  sources.reserve(cut.firsts[tile + 1] - cut.firsts[tile]);
  for (std::size_t j = cut.firsts[tile]; j < cut.firsts[tile + 1]; ++j) {
    const std::size_t index = offset + (cut.order.empty() ? j : cut.order[j]);
    sources.push_back(sourceIndex_->empty() ? index : (*sourceIndex_)[index]);
  }
  return sources;
}

}  // namespace bspc
