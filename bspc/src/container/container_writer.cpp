#include "container/container_writer.h"

#include "container/block.h"

namespace bspc::container {

ContainerWriter::ContainerWriter(ByteSink& sink, Layout layout, const Grid& grid, unsigned layers)
    : sink_(sink) {
  head_.layers = layers;
  head_.streaming = layout == Layout::Streaming;
  head_.grid = grid;
  if (head_.streaming) putHead();
}

void ContainerWriter::put(ByteView bytes) {
  sink_.write(bytes);
  written_ += bytes.size();
}

void ContainerWriter::putHead() {
  Bytes preamble(kSignature.begin(), kSignature.end());
  preamble.push_back(kVersionMajor);
  preamble.push_back(kVersionMinor);
  put(preamble);
  put(makeBlock(BlockType::Head, writeHead(head_), preamble));
}

void ContainerWriter::addTile(TileRecord record, std::vector<Bytes> chunks) {
  record.chunkSizes.assign(record.lacking, kNoChunk);
  record.coarse.insert(record.coarse.begin(), record.lacking, lackingLayer(record.extent));
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
  putHead();
  for (std::size_t column = 0; column < head_.columns(); ++column) {
    for (std::size_t tile = 0; tile < chunks_.size(); ++tile) {
      const unsigned lacking = head_.tiles[tile].lacking;
      if (column >= lacking) put(makeChunk(std::move(chunks_[tile][column - lacking])));
    }
  }
}

}  // namespace bspc::container
