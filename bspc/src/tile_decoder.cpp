#include "tile_decoder.h"

#include <string>

#include "bspc/error.h"
#include "container/checksum.h"

namespace bspc {

namespace {

/// What stands for a tile in layers that it lacks.
geometry::DecodedTile middleOnly(const container::TileRecord& record,
                                 const DecodeOptions& options) {
  geometry::DecodedTile tile;
  tile.points.push_back(container::middleOfBox(record.extent));
  if (options.wantCounts) tile.counts.push_back(record.points);
  if (options.cellLevel) tile.cellIds.push_back(0);
  return tile;
}

}  // namespace

const geometry::GeometryMethod& TileDecoder::methodOf(std::size_t tile) const {
  const container::TileRecord& record = file_.tiles()[tile];
  const geometry::GeometryMethod* method =
      geometry::findGeometryMethod(static_cast<Method>(record.method));
  if (method == nullptr || record.version > method->version()) {
    throw Error(ErrorCode::Unsupported,
                "tile " + std::to_string(tile) + " is coded by method number " +
                    std::to_string(record.method) + ", version " + std::to_string(record.version) +
                    ", which this version does not know; use a newer one");
  }
  if (record.points > method->maxPoints()) {
    throw Error(ErrorCode::Corrupt, "tile " + std::to_string(tile) + " claims " +
                                        std::to_string(record.points) +
                                        " points, more than its method allows");
  }
  return *method;
}

TileContent TileDecoder::decode(std::size_t tile, const Query& query, const DecodeOptions& options,
                                std::uint64_t memory, const geometry::PointProgress& progress) {
  const container::TileRecord& record = file_.tiles()[tile];
  const unsigned level = query.level;
  if (level < record.lacking) return {middleOnly(record, options), {}};
  methodOf(tile);
  requireRoom(pointsUpTo(record, level), bytesPerPoint(file_, query, options), limits_.points,
              memory);
  TileContent content;
  geometry::DecodedTile& decoded = content.points;
  decoded = decodePayloads(tile, level, options, memory, progress);
  check(tile, level, decoded);
  if (options.cellLevel && *options.cellLevel < record.lacking) {
    decoded.cellIds.assign(decoded.points.size(), 0);
  }
  if (query.arrays.empty() && !query.inputOrder) return content;
  const std::uint64_t used = decoded.points.capacity() * sizeof(GridPoint) +
                             (decoded.counts.size() + decoded.cellIds.size()) * 8 +
                             decoded.layerOrder.size() * sizeof(std::uint32_t);
  const auto readChunk = [&](std::size_t column) {
    if (progress) progress(decoded.points.size());
    const std::lock_guard<std::mutex> lock(reading_);
    return file_.chunk(tile, column);
  };
  TileArrayDecoder arrays(file_.layout(), record, decoded, level, readChunk);
  content.values = arrays.decode(query.arrays, query.inputOrder, memory > used ? memory - used : 0);
  return content;
}

geometry::DecodedTile TileDecoder::decodePayloads(std::size_t tile, unsigned level,
                                                  const DecodeOptions& options,
                                                  std::uint64_t memory,
                                                  const geometry::PointProgress& progress) {
  const container::TileRecord& record = file_.tiles()[tile];
  const std::vector<Bytes> payloads = readPayloads(tile, level);
  geometry::TileToDecode input;
  std::uint64_t payloadBytes = 0;
  for (const Bytes& payload : payloads) {
    input.payloads.emplace_back(payload);
    payloadBytes += payload.size();
  }
  input.version = record.version;
  input.points = record.points;
  input.extent = record.extent;
  input.layers = file_.head().layers - record.lacking;
  if (options.cellLevel && *options.cellLevel >= record.lacking) {
    input.cellLevel = *options.cellLevel - record.lacking;
  }
  input.wantCounts = options.wantCounts;
  input.maxPoints = limits_.points;
  input.maxBytes = memory > payloadBytes ? memory - payloadBytes : 0;
  input.maxDepth = limits_.depth;
  return methodOf(tile).decode(input, progress);
}

std::vector<Bytes> TileDecoder::readPayloads(std::size_t tile, unsigned level) {
  const std::lock_guard<std::mutex> lock(reading_);
  file_.checkTileBlock(tile);
  std::vector<Bytes> payloads;
  for (unsigned l = file_.tiles()[tile].lacking; l <= level; ++l) {
    payloads.push_back(file_.chunk(tile, file_.layout().column(l, container::kGeometryPart)));
  }
  return payloads;
}

void TileDecoder::check(std::size_t tile, unsigned level,
                        const geometry::DecodedTile& decoded) const {
  const container::TileRecord& record = file_.tiles()[tile];
  const bool complete = level + 1 == file_.head().layers;
  const std::uint64_t expected = complete ? record.points : record.coarse[level].representatives;
  const bool right =
      decoded.points.size() == expected &&
      (!complete || container::contentChecksum(decoded.points) == record.contentChecksum);
  if (right) return;
  throw Error(ErrorCode::Corrupt,
              "the points of tile " + std::to_string(tile) + " are not those that were written (" +
                  std::to_string(decoded.points.size()) + " of " + std::to_string(expected) +
                  " decoded, or wrong content checksum): the file is damaged, or this machine "
                  "does not calculate as it should");
}

}  // namespace bspc
