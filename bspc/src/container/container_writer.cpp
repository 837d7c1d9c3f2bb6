#include "container/container_writer.h"

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

/// Signature, version and head block.
Bytes fileStart(const FileHead& head) {
  Bytes start(kSignature.begin(), kSignature.end());
  start.push_back(kVersionMajor);
  start.push_back(kVersionMinor);
  const Bytes block = makeBlock(BlockType::Head, writeHead(head), start);
  start.insert(start.end(), block.begin(), block.end());
  return start;
}

}  // namespace

std::uint64_t writeProgressive(ByteSink& sink, const FileHead& head, const ChunkSource& chunks) {
  CountedSink out(sink);
  out.put(fileStart(head));
  for (std::size_t column = 0; column < head.columns(); ++column) {
    for (std::size_t tile = 0; tile < head.tiles.size(); ++tile) {
      if (column >= head.tiles[tile].lacking) out.put(makeChunk(chunks(tile, column)));
    }
  }
  return out.written();
}

ContainerWriter::ContainerWriter(ByteSink& sink, Layout layout, const Grid& grid, unsigned layers)
    : sink_(sink) {
  head_.layers = layers;
  head_.streaming = layout == Layout::Streaming;
  head_.grid = grid;
  if (head_.streaming) put(fileStart(head_));
}

void ContainerWriter::put(ByteView bytes) {
  sink_.write(bytes);
  written_ += bytes.size();
}

void ContainerWriter::addTile(TileRecord record, std::vector<Bytes> chunks) {
  record.chunkSizes.assign(record.lacking, kNoChunk);
  for (const Bytes& chunk : chunks) record.chunkSizes.push_back(chunk.size());
  if (head_.streaming) {
    ByteWriter content;
    writeTileRecord(content, record);
    put(makeBlock(BlockType::Tile, content.data()));
    for (Bytes& chunk : chunks) put(makeChunk(std::move(chunk)));
  } else {
    chunks_.push_back(std::move(chunks));
  }
  tiles_.push_back(std::move(record));
}

void ContainerWriter::finish() {
  if (head_.streaming) {
    const std::uint64_t indexOffset = written_;
    ByteWriter index;
    writeTileTable(index, tiles_);
    put(makeBlock(BlockType::Index, index.data()));
    ByteWriter end;
    end.unsignedLittle(indexOffset, kEndContent);
    put(makeBlock(BlockType::End, end.data()));
    return;
  }
  head_.tiles = std::move(tiles_);
  written_ = writeProgressive(sink_, head_, [this](std::size_t tile, std::size_t column) {
    return std::move(chunks_[tile][column - head_.tiles[tile].lacking]);
  });
}

}  // namespace bspc::container
