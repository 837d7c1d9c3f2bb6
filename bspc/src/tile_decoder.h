#pragma once

#include <cstdint>
#include <mutex>

#include "arrays/tile_array_decoder.h"
#include "bspc/decoder.h"
#include "container/container_reader.h"
#include "geometry/geometry_method.h"
#include "query.h"

namespace bspc {

/// A tile with what was asked of it.
struct TileContent {
  geometry::DecodedTile points;
  DecodedTileArrays values;
};

/// Reads and decodes tiles of a file and checks what comes out; on any number of threads at a time.
class TileDecoder {
 public:
  TileDecoder(const container::ContainerReader& file, const DecodeLimits& limits)
      : file_(file), limits_(limits) {}

  /// The method that a tile is coded by. Throws Error(Unsupported) if this version does not have
  /// it, Error(Corrupt) if the tile claims more points than the method allows.
  const geometry::GeometryMethod& methodOf(std::size_t tile) const;

  /// The tile up to the level of the query, relative to its lower corner, within `memory` bytes.
  /// Throws Error (Corrupt, Unsupported, LimitExceeded, Io).
  TileContent decode(std::size_t tile, const Query& query, const DecodeOptions& options,
                     std::uint64_t memory, const geometry::PointProgress& progress);

 private:
  geometry::DecodedTile decodePayloads(std::size_t tile, unsigned level,
                                       const DecodeOptions& options, std::uint64_t memory,
                                       const geometry::PointProgress& progress);
  std::vector<Bytes> readPayloads(std::size_t tile, unsigned level);
  void check(std::size_t tile, unsigned level, const geometry::DecodedTile& decoded) const;

  const container::ContainerReader& file_;
  const DecodeLimits& limits_;
  std::mutex reading_;  ///< sources are read by one thread at a time
};

}  // namespace bspc
