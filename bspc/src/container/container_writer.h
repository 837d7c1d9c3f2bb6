#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/io.h"
#include "container/file_head.h"

namespace bspc::container {

/// Writes a file tile by tile, in either layout. Tiles come with their chunks' payloads, one a
/// column of the chunk table but those that the record lacks.
class ContainerWriter {
 public:
  ContainerWriter(ByteSink& sink, Layout layout, const Grid& grid, unsigned layers);

  /// Streaming layout: written at once. Progressive layout: kept until finish(), since the layers
  /// of all tiles stand together.
  void addTile(TileRecord record, std::vector<Bytes> chunks);
  /// Writes what is left; nothing may follow.
  void finish();

  std::uint64_t bytesWritten() const { return written_; }

 private:
  void put(ByteView bytes);
  void putHead();

  ByteSink& sink_;
  FileHead head_;
  std::vector<TileRecord> tiles_;
  std::vector<std::vector<Bytes>> chunks_;  ///< progressive layout: of all tiles
  std::uint64_t written_ = 0;
};

}  // namespace bspc::container
