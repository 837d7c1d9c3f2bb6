#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "attributes/array_coder.h"
#include "bspc/decoder.h"
#include "container/container_reader.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// What is decoded of a tile beside its points.
struct DecodedTileArrays {
  std::vector<attributes::ArrayValues> arrays;  ///< the chosen ones, a tuple a decoded point
  /// Input index in the tile of each decoded point; empty if it is not asked for or not needed.
  std::vector<std::uint32_t> order;
};

/// Decodes the arrays of one tile.
class TileArrayDecoder {
 public:
  /// Gives the payload of a chunk, checked.
  using ReadChunk = std::function<Bytes(std::size_t column)>;

  /// All must outlive this; `points` are those of layers 0 … level.
  TileArrayDecoder(const container::TileLayout& layout, const container::TileRecord& record,
                   const geometry::DecodedTile& points, unsigned level, ReadChunk readChunk)
      : layout_(layout),
        record_(record),
        points_(points),
        level_(level),
        readChunk_(std::move(readChunk)) {}

  /// The arrays of those indices, which have values at the level; `wantOrder` if the points are to
  /// be put into the order of the input. Takes at most `maxBytes`.
  /// Throws Error(Corrupt, Unsupported, LimitExceeded, Io).
  DecodedTileArrays decode(const std::vector<std::size_t>& arrays, bool wantOrder,
                           std::uint64_t maxBytes);

 private:
  bool isLast() const { return level_ + 1 == layout_.layers; }
  void decodeOrder(const std::vector<std::size_t>& arrays, bool wantOrder,
                   DecodedTileArrays& result);
  void decodeLayer(unsigned layer, const std::vector<std::size_t>& arrays,
                   DecodedTileArrays& result);
  std::size_t pointsUpTo(unsigned layer) const;
  void check(const std::vector<std::size_t>& arrays, const DecodedTileArrays& result) const;
  std::uint64_t freeBytes() const { return maxBytes_ > used_ ? maxBytes_ - used_ : 0; }

  const container::TileLayout& layout_;
  const container::TileRecord& record_;
  const geometry::DecodedTile& points_;
  unsigned level_;
  ReadChunk readChunk_;
  std::vector<GridPoint> layered_;         ///< points layer after layer, if decoded otherwise
  std::vector<std::uint32_t> inputOrder_;  ///< of the points layer after layer
  std::uint64_t maxBytes_ = 0;
  std::uint64_t used_ = 0;
};

/// Bytes of the file that decoding those arrays of a tile takes, and the order if it is wished.
std::uint64_t bytesOfArrays(const container::ContainerReader& file, std::size_t tile,
                            unsigned level, const std::vector<std::size_t>& arrays, bool wantOrder);

}  // namespace bspc
