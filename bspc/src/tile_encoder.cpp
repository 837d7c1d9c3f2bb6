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

/// Where the points of a tile are decoded, from its lower corner.
std::vector<GridPoint> decodedPoints(const geometry::TileInput& tile,
                                     const std::vector<std::uint32_t>& order) {
  std::vector<GridPoint> decoded;
  decoded.reserve(order.size());
  for (const std::uint32_t i : order) {
    GridPoint p = tile.points[i];
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    decoded.push_back(p);
  }
  return decoded;
}

std::uint64_t totalSize(const std::vector<Bytes>& payloads) {
  std::uint64_t bytes = 0;
  for (const Bytes& payload : payloads) bytes += payload.size();
  return bytes;
}

}  // namespace

FinishedTile TileEncoder::encode(Span<const GridPoint> points,
                                 const std::vector<std::uint64_t>& sources,
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
  finished.record.coarse = coded.coarse;
  finished.geometryBytes = totalSize(coded.layers);
  if (!sources.empty()) {
    finished.sources.reserve(sources.size());
    for (const std::uint32_t i : coded.order) finished.sources.push_back(sources[i]);
  }
  finished.decoded = std::move(coded.decoded);
  finished.faces = std::move(coded.faces);
  if (arrays_.hasWork()) {
    const std::vector<GridPoint> own =
        finished.decoded.empty() ? decodedPoints(tile, coded.order) : std::vector<GridPoint>();
    const std::vector<GridPoint>& decoded = finished.decoded.empty() ? own : finished.decoded;
    finished.record.contentChecksum = container::contentChecksum(decoded);
    addArrays(arrays_.encode({coded, decoded, finished.sources}), coded, finished);
  } else {
    finished.record.contentChecksum = finished.decoded.empty()
                                          ? checksumInOrder(tile, coded.order)
                                          : container::contentChecksum(finished.decoded);
    finished.chunks = std::move(coded.layers);
  }
  return finished;
}

void TileEncoder::addArrays(CodedTileArrays arrays, geometry::EncodedTile& coded,
                            FinishedTile& finished) const {
  finished.record.order = arrays.order;
  finished.record.layeredArrays = arrays.layered;
  finished.record.arrays = std::move(arrays.arrays);
  finished.orderBytes = arrays.orderPayload.size();
  finished.arrayErrors = std::move(arrays.greatestErrors);
  for (const std::vector<Bytes>& payloads : arrays.payloads) {
    finished.arrayBytes.push_back(totalSize(payloads));
  }
  const std::size_t first = finished.record.firstArrayLayer(layers_);
  for (std::size_t l = 0; l < layers_; ++l) {
    finished.chunks.push_back(std::move(coded.layers[l]));
    if (l + 1 == layers_ && arrays.order == container::TileOrder::Stored) {
      finished.chunks.push_back(std::move(arrays.orderPayload));
    }
    for (std::vector<Bytes>& payloads : arrays.payloads) {
      if (l >= first) finished.chunks.push_back(std::move(payloads[l - first]));
    }
  }
}

}  // namespace bspc
