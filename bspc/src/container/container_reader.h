#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/io.h"
#include "container/file_head.h"

namespace bspc::container {

/// A file's head and index, and access to its chunks. Both layouts end up as the same table.
class ContainerReader {
 public:
  ContainerReader(std::shared_ptr<ByteSource> source, const OpenOptions& options);

  const FileHead& head() const { return head_; }
  const std::vector<TileRecord>& tiles() const { return head_.tiles; }
  unsigned versionMinor() const { return versionMinor_; }
  std::uint64_t fileBytes() const { return source_->size(); }
  /// Layers whose chunks, those of the arrays among them, are all inside the file; at least 1
  /// unless there are no tiles.
  unsigned wholeLayers() const { return wholeLayers_; }
  /// The Mesh blocks were lost at the end of a file that was cut short.
  bool meshMissing() const { return head_.mesh.blocks > meshBlocks_.size(); }
  /// Bytes of the file that Mesh blocks take.
  std::uint64_t meshBytes() const { return meshBytes_; }
  /// A Mesh block, checked; there must be as many.
  MeshBlock meshBlock(std::size_t number) const;
  /// Tiles were lost at the end (streaming layout, cut short).
  bool tilesMissing() const { return tilesMissing_; }

  /// Bytes that were read when the file was opened: its head and index.
  std::uint64_t overheadBytes() const { return overheadBytes_; }
  const TileLayout& layout() const { return layout_; }

  /// Bytes that reading a tile takes beside its chunks: its own record, in the streaming layout.
  std::uint64_t bytesOfRecord(std::size_t tile) const;
  /// Bytes of a chunk with its checksum; 0 if the tile has none in that column.
  std::uint64_t bytesOfChunk(std::size_t tile, std::size_t column) const;

  /// The payload of a chunk that the tile has, checked.
  Bytes chunk(std::size_t tile, std::size_t column) const;
  /// Streaming layout: checks that the tile's own record is that of the index.
  void checkTileBlock(std::size_t tile) const;

 private:
  void readPreamble();
  void openProgressive(std::uint64_t chunksOffset, const OpenOptions& options);
  void openStreaming(std::uint64_t firstTile, const OpenOptions& options);
  /// The index that the End block at the end of the file leads to; false if there is none.
  bool readIndex(std::uint64_t firstTile, const DecodeLimits& limits);
  void recoverTiles(std::uint64_t firstTile, const DecodeLimits& limits);
  /// What stands behind the tiles, which end at `offset`, and in front of the index.
  void readUpToIndex(std::uint64_t offset, std::uint64_t indexOffset);
  /// Finds the Mesh blocks that begin at `offset` and moves it behind them.
  void findMeshBlocks(std::uint64_t& offset);
  void readTrailingBlocks(std::uint64_t offset, std::uint64_t end) const;
  std::string chunkName(std::size_t tile, std::size_t column) const;

  std::shared_ptr<ByteSource> source_;
  FileHead head_;
  TileLayout layout_;
  unsigned versionMinor_ = 0;
  unsigned wholeLayers_ = 0;
  std::uint64_t overheadBytes_ = 0;
  bool tilesMissing_ = false;
  std::uint64_t meshBytes_ = 0;
  std::vector<std::uint64_t> meshBlocks_;    ///< offsets
  std::vector<std::uint64_t> chunkOffsets_;  ///< tile-major, layout_.columns() a tile
  std::vector<std::uint64_t> tileBlocks_;    ///< streaming layout: offsets of the tiles' blocks
};

}  // namespace bspc::container
