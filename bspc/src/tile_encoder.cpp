#include "tile_encoder.h"

#include <algorithm>

#include "container/checksum.h"

namespace bspc {

namespace {

geometry::TileInput describe(Span<const GridPoint> points) {
  geometry::TileInput tile;
  tile.points = points;
  tile.lower = points[0];
  GridPoint upper = points[0];
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      tile.lower[k] = std::min(tile.lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = upper[k] - tile.lower[k];
  return tile;
}

std::uint64_t checksumInOrder(const geometry::TileInput& tile,
                              const std::vector<std::uint32_t>& order) {
  constexpr std::size_t kPiece = 1024;
  constexpr std::size_t kAhead = 32;  // points that are fetched while others are taken
  container::ContentChecksum checksum;
  std::vector<GridPoint> piece(std::min(kPiece, order.size()));
  for (std::size_t first = 0; first < order.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, order.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t later = std::min(first + i + kAhead, order.size() - 1);
      __builtin_prefetch(&tile.points[order[later]]);
      const GridPoint& p = tile.points[order[first + i]];
      piece[i] = {p[0] - tile.lower[0], p[1] - tile.lower[1], p[2] - tile.lower[2]};
    }
    checksum.add(Span<const GridPoint>(piece.data(), count));
  }
  return checksum.value();
}

}  // namespace

FinishedTile TileEncoder::encode(Span<const GridPoint> points,
                                 const geometry::PointProgress& progress) const {
  geometry::TileInput tile = describe(points);
  tile.layers = layers_;
  tile.wishes = wishes_;
  geometry::EncodedTile coded = method_.encode(tile, progress);
  FinishedTile finished;
  finished.record.method = static_cast<unsigned>(method_.id());
  finished.record.version = coded.version;
  finished.record.points = points.size();
  finished.record.lower = tile.lower;
  finished.record.extent = tile.extent;
  finished.record.coarse = std::move(coded.coarse);
  finished.record.contentChecksum = coded.decoded.empty()
                                        ? checksumInOrder(tile, coded.order)
                                        : container::contentChecksum(coded.decoded);
  finished.chunks = std::move(coded.layers);
  finished.order = std::move(coded.order);
  finished.decoded = std::move(coded.decoded);
  return finished;
}

}  // namespace bspc
