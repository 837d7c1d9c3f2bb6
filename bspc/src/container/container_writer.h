#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/io.h"
#include "container/file_head.h"

namespace bspc::container {

/// Gives the payload of a tile's chunk in a column.
using ChunkSource = std::function<Bytes(std::size_t tile, std::size_t column)>;

/// Gives the content of a Mesh block by its number.
using MeshSource = std::function<Bytes(std::size_t block)>;

/// How a file begins: signature, version and head block.
Bytes fileStart(const FileHead& head);
/// How a file in the streaming layout ends: the index block with a tile table, and the end block
/// that leads to it.
Bytes fileEnd(ByteView table, std::uint64_t indexOffset);

/// Writes a whole file in the progressive layout; head.tiles has the sizes of all chunks. Asks for
/// each chunk that there is, column by column, and then for head.mesh.blocks Mesh blocks. Returns
/// the bytes written.
std::uint64_t writeProgressive(ByteSink& sink, const FileHead& head, const ChunkSource& chunks,
                               const MeshSource& mesh);

/// Writes a file tile by tile, in either layout.
class ContainerWriter {
 public:
  /// The head without tiles and sizes; its layout flag is set to `layout`.
  ContainerWriter(ByteSink& sink, Layout layout, FileHead head);

  /// Takes a tile with the payloads of the chunks that its record says it has, in the order of
  /// their columns. Streaming layout: written at once. Progressive layout: kept until finish(),
  /// since the layers of all tiles stand together.
  void addTile(TileRecord record, std::vector<Bytes> chunks);
  /// Writes what is left, the Mesh blocks (as many as the head says) among it; nothing may follow.
  void finish(const MeshSource& mesh = {});

  std::uint64_t bytesWritten() const { return written_; }

 private:
  void put(ByteView bytes);

  ByteSink& sink_;
  FileHead head_;
  TileLayout layout_;
  std::vector<TileRecord> tiles_;
  std::vector<std::vector<Bytes>> chunks_;  ///< progressive layout: of all tiles
  std::uint64_t written_ = 0;
};

}  // namespace bspc::container
