#include "container/container_writer.h"

#include <utility>

#include "container/block.h"

namespace bspc::container {

namespace {

/// Counts what goes to a sink.
class CountedSink {
 public:
  explicit CountedSink(ByteSink& sink) : sink_(sink) {}
  void put(ByteView bytes) {
    sink_.write(bytes);
    written_ += bytes.size();
  }
  std::uint64_t written() const { return written_; }

 private:
  ByteSink& sink_;
  std::uint64_t written_ = 0;
};

}  // namespace

Bytes fileStart(const FileHead& head) {
  Bytes start(kSignature.begin(), kSignature.end());
  start.push_back(kVersionMajor);
  start.push_back(kVersionMinor);
  const Bytes block = makeBlock(BlockType::Head, writeHead(head), start);
  start.insert(start.end(), block.begin(), block.end());
  return start;
}

Bytes fileEnd(ByteView table, std::uint64_t indexOffset) {
  Bytes bytes = makeBlock(BlockType::Index, table);
  ByteWriter end;
  end.unsignedLittle(indexOffset, kEndContent);
  const Bytes block = makeBlock(BlockType::End, end.data());
  bytes.insert(bytes.end(), block.begin(), block.end());
  return bytes;
}

std::uint64_t writeProgressive(ByteSink& sink, const FileHead& head, const ChunkSource& chunks,
                               const MeshSource& mesh) {
  CountedSink out(sink);
  out.put(fileStart(head));
  const std::size_t columns = head.layout().columns();
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t tile = 0; tile < head.tiles.size(); ++tile) {
      if (head.tiles[tile].chunkSizes[column] == kNoChunk) continue;
      out.put(makeChunk(chunks(tile, column)));
    }
  }
  for (std::size_t block = 0; block < head.mesh.blocks; ++block) {
    out.put(makeBlock(BlockType::Mesh, mesh(block)));
  }
  return out.written();
}

ContainerWriter::ContainerWriter(ByteSink& sink, Layout layout, FileHead head)
    : sink_(sink), head_(std::move(head)), layout_(head_.layout()) {
  head_.streaming = layout == Layout::Streaming;
  if (head_.streaming) put(fileStart(head_));
}

void ContainerWriter::put(ByteView bytes) {
  sink_.write(bytes);
  written_ += bytes.size();
}

void ContainerWriter::addTile(TileRecord record, std::vector<Bytes> chunks) {
  record.chunkSizes.assign(layout_.columns(), kNoChunk);
  std::size_t next = 0;
  for (std::size_t column = 0; column < layout_.columns(); ++column) {
    if (record.hasChunk(layout_, column)) record.chunkSizes[column] = chunks[next++].size();
  }
  if (head_.streaming) {
    ByteWriter content;
    writeTileRecord(content, layout_, record);
    put(makeBlock(BlockType::Tile, content.data()));
    for (Bytes& chunk : chunks) put(makeChunk(std::move(chunk)));
  } else {
    chunks_.push_back(std::move(chunks));
  }
  tiles_.push_back(std::move(record));
}

void ContainerWriter::finish(const MeshSource& mesh) {
  if (head_.streaming) {
    for (std::size_t block = 0; block < head_.mesh.blocks; ++block) {
      put(makeBlock(BlockType::Mesh, mesh(block)));
    }
    ByteWriter table;
    writeTileTable(table, layout_, tiles_);
    put(fileEnd(table.data(), written_));
    return;
  }
  head_.tiles = std::move(tiles_);
  std::vector<std::size_t> next(head_.tiles.size());
  const ChunkSource chunks = [&](std::size_t tile, std::size_t /*column*/) {
    return std::move(chunks_[tile][next[tile]++]);
  };
  written_ = writeProgressive(sink_, head_, chunks, mesh);
}

}  // namespace bspc::container
