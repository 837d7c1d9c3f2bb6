#pragma once

#include <cstdint>
#include <mutex>

#include "bspc/decoder.h"
#include "container/container_reader.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// Reads and decodes tiles of a file and checks what comes out; on any number of threads at a time.
class TileDecoder {
 public:
  TileDecoder(const container::ContainerReader& file, const DecodeLimits& limits)
      : file_(file), limits_(limits) {}

  /// The tile up to `level`, relative to its lower corner, within `memory` bytes.
  /// Throws Error (Corrupt, Unsupported, LimitExceeded, Io).
  geometry::DecodedTile decode(std::size_t tile, unsigned level, const DecodeOptions& options,
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
