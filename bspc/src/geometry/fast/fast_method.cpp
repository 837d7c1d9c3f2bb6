#include "geometry/fast/fast_method.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "bspc/error.h"
#include "geometry/fast/input_order.h"
#include "geometry/fast/set_coder.h"
#include "geometry/fast/tile_header.h"
#include "geometry/fast/tile_sequence.h"

namespace bspc::geometry {

namespace fast {
namespace {

std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// How far points lie from those that stand for them in a layer.
LayerSummary summaryOf(const TileInput& tile, const std::vector<std::uint32_t>& sequence,
                       const LayerStrides& strides, unsigned layer) {
  LayerSummary summary;
  summary.representatives = strides.upTo(layer);
  const unsigned bits = strides.strideBits(layer);
  for (std::size_t place = 0; place < sequence.size(); ++place) {
    const GridPoint& p = tile.points[sequence[place]];
    const GridPoint& r = tile.points[sequence[(place >> bits) << bits]];
    for (unsigned k = 0; k < 3; ++k)
      summary.spread = std::max(summary.spread, distance(p[k], r[k]));
  }
  return summary;
}

std::vector<std::uint32_t> identity(std::size_t count) {
  std::vector<std::uint32_t> sequence(count);
  std::iota(sequence.begin(), sequence.end(), 0U);
  return sequence;
}

std::vector<std::uint32_t> sequenceOf(const TileInput& tile) {
  std::vector<GridPoint> points(tile.points.begin(), tile.points.end());
  for (GridPoint& p : points) {
    for (unsigned k = 0; k < 3; ++k) p[k] -= tile.lower[k];
  }
  return hilbertSequence(points, tile.extent);
}

/// The points that come with a layer.
SetPoints pointsOfLayer(const RankedPoints& ranked, const std::vector<std::uint32_t>& sequence,
                        const LayerStrides& strides, unsigned layer) {
  std::vector<std::uint32_t> chosen;
  chosen.reserve(strides.inLayer(layer));
  for (std::uint64_t stop = 0; stop < strides.upTo(layer); ++stop) {
    const std::uint64_t place = stop << strides.strideBits(layer);
    if (strides.isNew(place, layer)) chosen.push_back(sequence[place]);
  }
  return {ranked, std::move(chosen)};
}

/// With the scale that `header` has.
EncodedTile encodeAlongHilbert(const TileInput& tile, const RankedPoints& ranked,
                               const TileHeader& header, const PointProgress& progress) {
  EncodedTile result;
  result.nestsPoints = true;
  const bool layered = tile.layers > 1;
  const std::vector<std::uint32_t> sequence =
      layered ? sequenceOf(tile) : std::vector<std::uint32_t>();
  const LayerStrides strides(tile.points.size(), tile.layers, header.ratioBits);
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    container::ByteWriter start;
    if (layer == 0) writeHeader(start, header, tile.layers);
    Bytes payload = start.take();
    const SetPoints points =
        layered ? pointsOfLayer(ranked, sequence, strides, layer) : SetPoints(ranked);
    if (points.size() > 0) {
      CodedSet set = encodeSet(header.frame, points, tile.wishes.effort);
      set.bytes.insert(set.bytes.begin(), payload.begin(), payload.end());
      payload = std::move(set.bytes);
      if (result.order.empty()) {
        result.order = std::move(set.order);
      } else {
        result.order.insert(result.order.end(), set.order.begin(), set.order.end());
      }
    }
    result.layers.push_back(std::move(payload));
    if (layer + 1 < tile.layers) {
      result.coarse.push_back(summaryOf(tile, sequence, strides, layer));
    }
    if (progress) progress(result.order.size());
  }
  return result;
}

std::size_t totalBytes(const EncodedTile& coded) {
  std::size_t bytes = 0;
  for (const Bytes& layer : coded.layers) bytes += layer.size();
  return bytes;
}

/// Tiles of so few points take little time whatever is tried.
constexpr std::size_t kFewPoints = 8192;

/// Whether ways to code a tile are tried that take much longer than the usual one.
bool isThorough(const RankedPoints& ranked, unsigned effort) {
  return effort >= 3 || ranked.size() <= kFewPoints;
}

/// Whether the order of the input is worth a try: it is slower to code.
bool isInputOrderPromising(const RankedPoints& ranked, unsigned effort, const EncodedTile& other) {
  constexpr double kAllowance = 1.1;  // the sample may be worse than the whole
  if (!isThorough(ranked, effort)) return false;
  const std::size_t points = ranked.size();
  if (points <= kFewPoints) return true;
  const double otherBits = 8.0 * static_cast<double>(totalBytes(other));
  return estimateInInputOrder(ranked) * static_cast<double>(points) < kAllowance * otherBits;
}

EncodedTile encodeInInputOrder(const TileInput& tile, const RankedPoints& ranked) {
  TileHeader header = ranked.header();
  header.sequence = Sequence::Input;
  EncodedTile result;
  result.order = identity(tile.points.size());
  const LayerStrides strides(tile.points.size(), tile.layers, header.ratioBits);
  result.nestsPoints = true;
  if (tile.layers > 1) result.layerOrder = strides.layerAfterLayer(tile.layers - 1);
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    container::ByteWriter payload;
    if (layer == 0) writeHeader(payload, header, tile.layers);
    if (strides.inLayer(layer) > 0) payload.bytes(writeInInputOrder(ranked, strides, layer));
    result.layers.push_back(payload.take());
    if (layer + 1 < tile.layers) {
      result.coarse.push_back(summaryOf(tile, result.order, strides, layer));
    }
  }
  return result;
}

/// Counts and cells of decoded points, which are all of layers 0 … `layer`.
void describeCells(const TileToDecode& tile, const LayerStrides& strides, unsigned layer,
                   const std::vector<std::uint32_t>& sequence, DecodedTile& out) {
  const unsigned bits = strides.strideBits(layer);
  if (tile.wantCounts) out.counts.resize(out.points.size());
  if (tile.cellLevel) out.cellIds.resize(out.points.size());
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const std::uint64_t place = static_cast<std::uint64_t>(i) << bits;
    if (tile.wantCounts) {
      out.counts[sequence[i]] = std::min(std::uint64_t{1} << bits, tile.points - place);
    }
    if (tile.cellLevel) {
      out.cellIds[sequence[i]] = place >> strides.strideBits(*tile.cellLevel);
    }
  }
}

}  // namespace
}  // namespace fast

EncodedTile FastMethod::encode(const TileInput& tile, const PointProgress& progress) const {
  if (tile.points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Unsupported,
                "method fast codes at most 4,294,967,295 points in one tile, and this set has " +
                    std::to_string(tile.points.size()));
  }
  const fast::RankedPoints ranked(tile);
  EncodedTile best = fast::encodeAlongHilbert(tile, ranked, ranked.header(), progress);
  if (fast::isThorough(ranked, tile.wishes.effort) &&
      ranked.otherScale() != ranked.header().frame.scale) {
    fast::TileHeader rescaled = ranked.header();
    rescaled.frame.scale = ranked.otherScale();
    EncodedTile other = fast::encodeAlongHilbert(tile, ranked, rescaled, progress);
    if (fast::totalBytes(other) < fast::totalBytes(best)) best = std::move(other);
  }
  if (fast::isInputOrderPromising(ranked, tile.wishes.effort, best)) {
    EncodedTile other = fast::encodeInInputOrder(tile, ranked);
    if (fast::totalBytes(other) < fast::totalBytes(best)) best = std::move(other);
  }
  return best;
}

DecodedTile FastMethod::decode(const TileToDecode& tile, const PointProgress& progress) const {
  if (tile.points > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Corrupt, "a tile of method fast claims " + std::to_string(tile.points) +
                                        " points, more than the method allows");
  }
  DecodedTile result;
  const OutputBudget budget(tile);
  container::ByteReader first(tile.payloads[0], "a tile of method fast",
                              container::ByteReader::kNoOffset);
  const fast::TileHeader header = fast::readHeader(first, tile, budget);
  const fast::LayerStrides strides(tile.points, tile.layers, header.ratioBits);
  fast::PointCollector collector(header.frame, budget, progress, result);
  const bool inputOrder = header.sequence == fast::Sequence::Input;
  std::vector<GridPoint> inOrder;
  for (unsigned layer = 0; layer < tile.payloads.size(); ++layer) {
    const ByteView payload = layer == 0 ? first.bytes(first.remaining()) : tile.payloads[layer];
    const std::uint64_t points = strides.inLayer(layer);
    if (points == 0) {
      if (!payload.empty()) throw Error(ErrorCode::Corrupt, "a layer without points has bytes");
    } else if (inputOrder) {
      fast::readInInputOrder(payload, strides, layer, header.frame.extent, tile, progress, inOrder);
    } else {
      fast::decodeSet(payload, points, tile, collector);
    }
  }
  collector.append(inOrder.data(), inOrder.size());
  if (inputOrder && tile.layers > 1) {
    budget.checkBytes(result.points.size() * (sizeof(GridPoint) + sizeof(std::uint32_t)));
    result.layerOrder = strides.layerAfterLayer(static_cast<unsigned>(tile.payloads.size()) - 1);
  }
  if (tile.wantCounts || tile.cellLevel) {
    constexpr std::uint64_t kSortBytes = 40;  // per point: places, keys and their copies
    budget.checkBytes(result.points.size() * kSortBytes);
    const std::vector<std::uint32_t> sequence =
        inputOrder ? fast::identity(result.points.size())
                   : fast::hilbertSequence(result.points, tile.extent);
    fast::describeCells(tile, strides, static_cast<unsigned>(tile.payloads.size()) - 1, sequence,
                        result);
  }
  return result;
}

}  // namespace bspc::geometry
