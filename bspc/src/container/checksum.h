#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "attributes/array_coder.h"
#include "bspc/grid.h"
#include "bspc/mesh.h"
#include "bspc/span.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// Bytes of the checksum of `size` bytes of content: short content has a short one.
constexpr unsigned checksumWidth(std::uint64_t size) { return size < 65536 ? 4 : 8; }

/// XXH3 (64 bits, seed 0) of the bytes, cut to the low `width` bytes.
std::uint64_t checksum(ByteView bytes, unsigned width);

/// The checksum of a tile's decoded content: its points in decoded order, from the tile's lower
/// corner, as little-endian 32-bit x, y, z. `width` is that of 12 bytes a point.
std::uint64_t contentChecksum(Span<const GridPoint> points);

/// The same of points that come piece by piece.
class ContentChecksum {
 public:
  ContentChecksum();
  ContentChecksum(const ContentChecksum&) = delete;
  ContentChecksum& operator=(const ContentChecksum&) = delete;
  ~ContentChecksum();

  void add(Span<const GridPoint> points);
  /// Of all points that were added.
  std::uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};
unsigned contentChecksumWidth(std::uint64_t points);

/// The checksum of the values of an array in decoded order: numbers as little-endian bytes, a byte
/// for each Bit, strings as their length in eight little-endian bytes and their bytes. `width` is
/// that of a fixed number of bytes a point, 8 for strings.
std::uint64_t valuesChecksum(const attributes::ArrayShape& shape,
                             const attributes::ArrayValues& values, std::uint64_t points);
unsigned valuesChecksumWidth(const attributes::ArrayShape& shape, std::uint64_t points);

/// The checksum of the cells over the points of a Mesh block, in decoded order: for vertex cells,
/// lines and faces how many points each cell has, and then these, as little-endian 32-bit numbers.
/// `width` is that of 16 bytes a cell.
std::uint64_t cellsChecksum(const MeshCells& cells);
unsigned cellsChecksumWidth(std::uint64_t cells);

}  // namespace bspc::container
