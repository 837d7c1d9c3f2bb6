#include "bspc/decoder.h"

#include <algorithm>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "container/checksum.h"
#include "container/container_reader.h"
#include "decoded_tiles.h"
#include "geometry/geometry_method.h"
#include "progress_scale.h"

namespace bspc {

namespace {

std::uint64_t saturatingAdd(std::uint64_t a, std::uint64_t b) {
  return b > std::numeric_limits<std::uint64_t>::max() - a
             ? std::numeric_limits<std::uint64_t>::max()
             : a + b;
}

void addTileInfo(FileInfo& info, const container::TileRecord& tile) {
  TileInfo t;
  t.method = static_cast<Method>(tile.method);
  t.methodVersion = tile.version;
  t.points = tile.points;
  t.lower = tile.lower;
  for (std::size_t k = 0; k < 3; ++k) {
    t.upper[k] = tile.lower[k] + tile.extent[k];
    info.lower[k] = info.tiles.empty() ? t.lower[k] : std::min(info.lower[k], t.lower[k]);
    info.upper[k] = std::max(info.upper[k], t.upper[k]);
  }
  info.points = saturatingAdd(info.points, tile.points);
  for (std::size_t l = 0; l < info.layers.size(); ++l) {
    const bool last = l == tile.coarse.size();
    info.layers[l].points =
        saturatingAdd(info.layers[l].points, last ? tile.points : tile.coarse[l].representatives);
    if (!last) info.layers[l].spread = std::max(info.layers[l].spread, tile.coarse[l].spread);
    info.layers[l].bytes = saturatingAdd(info.layers[l].bytes, tile.chunkSizes[l]);
    info.geometryBytes = saturatingAdd(info.geometryBytes, tile.chunkSizes[l]);
  }
  info.tiles.push_back(t);
}

FileInfo describe(const container::ContainerReader& file) {
  FileInfo info;
  info.versionMajor = container::kVersionMajor;
  info.versionMinor = file.versionMinor();
  info.streaming = file.head().streaming;
  info.grid = file.head().grid;
  info.fileBytes = file.fileBytes();
  info.layers.resize(file.head().layers);
  info.wholeLayers = file.wholeLayers();
  for (const container::TileRecord& tile : file.tiles()) addTileInfo(info, tile);
  return info;
}

}  // namespace

class Decoder::Impl {
 public:
  Impl(std::shared_ptr<ByteSource> source, const OpenOptions& options)
      : file_(std::move(source), options), info_(describe(file_)), limits_(options.limits) {}

  const FileInfo& info() const { return info_; }
  DecodedPoints decode(const DecodeOptions& options);

 private:
  unsigned chooseLevel(const DecodeOptions& options) const;
  geometry::DecodedTile decodeTile(std::size_t index, unsigned level, const DecodeOptions& options,
                                   std::uint64_t bytesInUse, ProgressScale& progress) const;
  void checkTile(std::size_t index, unsigned level, const geometry::DecodedTile& tile) const;

  container::ContainerReader file_;
  FileInfo info_;
  DecodeLimits limits_;
};

unsigned Decoder::Impl::chooseLevel(const DecodeOptions& options) const {
  const auto layers = static_cast<unsigned>(info_.layers.size());
  if (options.level && *options.level >= layers) {
    throw Error(ErrorCode::InvalidArgument, "level " + std::to_string(*options.level) +
                                                " was asked for; the file has levels " + "0 to " +
                                                std::to_string(layers - 1));
  }
  if (options.level && *options.level >= info_.wholeLayers) {
    throw Error(ErrorCode::Truncated,
                "level " + std::to_string(*options.level) +
                    " was asked for, and the file was cut short after level " +
                    std::to_string(info_.wholeLayers - 1));
  }
  unsigned level = options.level.value_or(std::max(info_.wholeLayers, 1U) - 1);
  if (options.maxPoints) {
    while (level > 0 && info_.layers[level].points > *options.maxPoints) --level;
  }
  if (options.cellLevel && *options.cellLevel > level) {
    throw Error(ErrorCode::InvalidArgument, "cells of level " + std::to_string(*options.cellLevel) +
                                                " were asked for, and only levels up to " +
                                                std::to_string(level) + " are decoded");
  }
  return level;
}

geometry::DecodedTile Decoder::Impl::decodeTile(std::size_t index, unsigned level,
                                                const DecodeOptions& options,
                                                std::uint64_t bytesInUse,
                                                ProgressScale& progress) const {
  const container::TileRecord& record = file_.tiles()[index];
  const geometry::GeometryMethod* method =
      geometry::findGeometryMethod(static_cast<Method>(record.method));
  if (method == nullptr || record.version > method->version()) {
    throw Error(ErrorCode::Unsupported,
                "tile " + std::to_string(index) + " is coded by method number " +
                    std::to_string(record.method) + ", version " + std::to_string(record.version) +
                    ", which this version does not know; use a newer one");
  }
  file_.checkTileBlock(index);
  std::vector<Bytes> payloads;
  std::uint64_t payloadBytes = 0;
  geometry::TileToDecode tile;
  for (unsigned l = 0; l <= level; ++l) {
    payloads.push_back(file_.chunk(index, l));
    payloadBytes += payloads.back().size();
  }
  tile.payloads.assign(payloads.begin(), payloads.end());
  tile.version = record.version;
  tile.points = record.points;
  tile.extent = record.extent;
  tile.layers = file_.head().layers;
  tile.cellLevel = options.cellLevel;
  tile.wantCounts = options.wantCounts;
  tile.maxPoints = limits_.points;
  const std::uint64_t used = saturatingAdd(bytesInUse, payloadBytes);
  tile.maxBytes = limits_.memoryBytes > used ? limits_.memoryBytes - used : 0;
  tile.maxDepth = limits_.depth;
  const auto share = static_cast<double>(record.points);
  geometry::DecodedTile decoded = method->decode(tile, [&progress, share](std::uint64_t done) {
    progress.report(static_cast<double>(done) / share);
  });
  checkTile(index, level, decoded);
  return decoded;
}

void Decoder::Impl::checkTile(std::size_t index, unsigned level,
                              const geometry::DecodedTile& tile) const {
  const container::TileRecord& record = file_.tiles()[index];
  const bool complete = level + 1 == file_.head().layers;
  const std::uint64_t expected = complete ? record.points : record.coarse[level].representatives;
  const bool right =
      tile.points.size() == expected &&
      (!complete || container::contentChecksum(tile.points) == record.contentChecksum);
  if (!right) {
    throw Error(ErrorCode::Corrupt,
                "the points of tile " + std::to_string(index) +
                    " are not those that were written (" + std::to_string(tile.points.size()) +
                    " of " + std::to_string(expected) +
                    " decoded, or wrong content checksum): the file is damaged, or this machine "
                    "does not calculate as it should");
  }
}

DecodedPoints Decoder::Impl::decode(const DecodeOptions& options) {
  DecodedPoints result;
  result.level = chooseLevel(options);
  const auto layers = static_cast<unsigned>(info_.layers.size());
  result.complete = result.level + 1 == layers && !file_.tilesMissing();
  const bool thin = options.maxPoints && info_.layers[result.level].points > *options.maxPoints;
  DecodedTiles all(limits_, options.wantCounts, options.cellLevel.has_value());
  const auto total = static_cast<double>(std::max<std::uint64_t>(info_.points, 1));
  double done = 0;
  for (std::size_t i = 0; i < file_.tiles().size(); ++i) {
    const auto points = static_cast<double>(file_.tiles()[i].points);
    ProgressScale progress(options.progress, done / total, (done + points) / total);
    progress.report(0);
    geometry::DecodedTile tile = decodeTile(i, result.level, options, all.bytes(), progress);
    all.append(std::move(tile), file_.tiles()[i].lower);
    done += points;
  }
  all.moveInto(result);
  if (thin) {
    thinTo(*options.maxPoints, result);
    result.complete = false;
  }
  ProgressScale(options.progress, 1, 1).report(1);
  return result;
}

Decoder::Decoder(std::shared_ptr<ByteSource> source, const OpenOptions& options)
    : impl_(std::make_unique<Impl>(std::move(source), options)) {}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

const FileInfo& Decoder::info() const { return impl_->info(); }

DecodedPoints Decoder::decode(const DecodeOptions& options) { return impl_->decode(options); }

bool isBspc(ByteView firstBytes) {
  return firstBytes.size() >= container::kSignature.size() &&
         std::equal(container::kSignature.begin(), container::kSignature.end(), firstBytes.begin());
}

}  // namespace bspc
