#include "container/container_reader.h"

#include <algorithm>
#include <limits>

#include "bspc/error.h"
#include "container/block.h"
#include "saturating.h"

namespace bspc::container {

namespace {

std::uint64_t saturatingChunkSize(std::uint64_t payload) {
  if (payload == kNoChunk) return 0;
  constexpr std::uint64_t kMaxChecksum = 8;
  return payload > std::numeric_limits<std::uint64_t>::max() - kMaxChecksum
             ? std::numeric_limits<std::uint64_t>::max()
             : chunkSize(payload);
}

std::string layerRange(unsigned layers) {
  return layers == 1 ? "layer 0 is" : "layers 0 to " + std::to_string(layers - 1) + " are";
}

}  // namespace

ContainerReader::ContainerReader(std::shared_ptr<ByteSource> source, const OpenOptions& options)
    : source_(std::move(source)) {
  readPreamble();
  const Block block = readBlock(*source_, kPreambleSize, kPreambleSize, "the head");
  if (block.type != static_cast<unsigned>(BlockType::Head)) {
    throw Error(ErrorCode::Corrupt, "the file does not begin with a head block");
  }
  ByteReader in(block.content, "the head", block.contentOffset);
  head_ = readHead(in, options.limits);
  layout_ = head_.layout();
  overheadBytes_ = block.end;
  if (head_.streaming) {
    openStreaming(block.end, options);
  } else {
    openProgressive(block.end, options);
  }
}

void ContainerReader::readPreamble() {
  const auto have =
      static_cast<std::size_t>(std::min<std::uint64_t>(source_->size(), kPreambleSize));
  Bytes preamble(have);
  if (have > 0) source_->read(0, preamble);
  const std::size_t compared = std::min(have, kSignature.size());
  const bool like =
      std::equal(preamble.begin(), preamble.begin() + static_cast<std::ptrdiff_t>(compared),
                 kSignature.begin());
  if (have == 0 || !like) {
    throw Error(ErrorCode::NotBspc, have == 0 ? "the file is empty, not a .bspc file"
                                              : "the file does not begin with the signature of a "
                                                ".bspc file");
  }
  if (have < kPreambleSize) {
    throw Error(ErrorCode::Truncated, "the file ends early, after " + std::to_string(have) +
                                          " bytes, inside its signature");
  }
  const unsigned major = preamble[kSignature.size()];
  if (major != kVersionMajor) {
    throw Error(
        ErrorCode::Unsupported,
        "the file has format version " + std::to_string(major) + "." +
            std::to_string(preamble[kSignature.size() + 1]) +
            (major < kVersionMajor ? ", a draft of before version 1.0; encode it anew"
                                   : ", and this program reads version " +
                                         std::to_string(kVersionMajor) + "; use a newer one"));
  }
  versionMinor_ = preamble[kSignature.size() + 1];
}

void ContainerReader::openProgressive(std::uint64_t chunksOffset, const OpenOptions& options) {
  const std::size_t columns = layout_.columns();
  const std::uint64_t size = source_->size();
  chunkOffsets_.resize(head_.tiles.size() * columns);
  std::uint64_t offset = chunksOffset;
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t tile = 0; tile < head_.tiles.size(); ++tile) {
      chunkOffsets_[tile * columns + column] = offset;
      offset = saturatingAdd(offset, saturatingChunkSize(head_.tiles[tile].chunkSizes[column]));
    }
    if (offset <= size && layout_.partOf(column) + 1 == layout_.parts()) ++wholeLayers_;
  }
  if (offset <= size) {
    try {
      findMeshBlocks(offset);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Truncated || !options.allowPartial) throw;
      return;
    }
    if (head_.trailingBlocks) {
      readTrailingBlocks(offset, size);
    } else if (offset < size) {
      throw Error(ErrorCode::Corrupt, "the file goes on for " + std::to_string(size - offset) +
                                          " bytes after its end at byte " + std::to_string(offset));
    }
    return;
  }
  const std::string where =
      "the file ends early, at byte " + std::to_string(size) + " of " + std::to_string(offset);
  if (wholeLayers_ == 0) {
    throw Error(ErrorCode::Truncated, where + ", inside its first layer: no layer can be decoded");
  }
  if (!options.allowPartial) {
    throw Error(ErrorCode::Truncated, where + "; " + layerRange(wholeLayers_) +
                                          " whole and can be decoded with --partial");
  }
}

void ContainerReader::openStreaming(std::uint64_t firstTile, const OpenOptions& options) {
  if (!readIndex(firstTile, options.limits)) {
    recoverTiles(firstTile, options.limits);
    const std::string found = std::to_string(head_.tiles.size()) + " tiles";
    if (head_.tiles.empty() || !options.allowPartial) {
      throw Error(ErrorCode::Truncated,
                  "the file ends early, at byte " + std::to_string(source_->size()) +
                      ", without its index; " +
                      (head_.tiles.empty() ? "no tile can be decoded"
                                           : found + " are whole and can be decoded with "
                                                     "--partial"));
    }
    tilesMissing_ = true;
  }
  wholeLayers_ = head_.layers;
}

bool ContainerReader::readIndex(std::uint64_t firstTile, const DecodeLimits& limits) {
  const std::uint64_t size = source_->size();
  if (size < firstTile + kEndBlock) return false;
  std::uint64_t indexOffset = 0;
  try {
    const Block end = readBlock(*source_, size - kEndBlock, 0, "the end block");
    if (end.type != static_cast<unsigned>(BlockType::End) || end.content.size() != kEndContent) {
      return false;
    }
    ByteReader in(end.content, "the end block", end.contentOffset);
    indexOffset = in.unsignedLittle(kEndContent);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Io) throw;
    return false;  // whatever stands there is not an end block
  }
  if (indexOffset < firstTile || indexOffset >= size - kEndBlock) {
    throw Error(ErrorCode::Corrupt, "the end block leads to an index at byte " +
                                        std::to_string(indexOffset) + ", outside the file");
  }
  const Block index = readBlock(*source_, indexOffset, 0, "the index");
  if (index.type != static_cast<unsigned>(BlockType::Index) || index.end != size - kEndBlock) {
    throw Error(ErrorCode::Corrupt, "the end block does not lead to the index but to byte " +
                                        std::to_string(indexOffset));
  }
  ByteReader in(index.content, "the index", index.contentOffset);
  std::vector<std::size_t> recordSizes;
  head_.tiles = readTileTable(in, layout_, limits, &recordSizes);
  in.expectEnd();
  std::uint64_t offset = firstTile;
  for (std::size_t tile = 0; tile < head_.tiles.size(); ++tile) {
    tileBlocks_.push_back(offset);
    offset = saturatingAdd(offset, blockSize(recordSizes[tile]));
    for (const std::uint64_t payload : head_.tiles[tile].chunkSizes) {
      chunkOffsets_.push_back(offset);
      offset = saturatingAdd(offset, saturatingChunkSize(payload));
    }
  }
  readUpToIndex(offset, indexOffset);
  overheadBytes_ += size - indexOffset;
  return true;
}

void ContainerReader::readUpToIndex(std::uint64_t offset, std::uint64_t indexOffset) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::Corrupt, what + " does not fit in front of the index of the file");
  };
  if (offset > indexOffset) fail("the last tile");
  try {
    findMeshBlocks(offset);
    if (offset > indexOffset) fail("the last block of cells");
    readTrailingBlocks(offset, indexOffset);
  } catch (const Error& error) {
    // A file with an index is whole: what it lacks was never there.
    if (error.code() == ErrorCode::Truncated) fail("a block");
    throw;
  }
}

void ContainerReader::recoverTiles(std::uint64_t firstTile, const DecodeLimits& limits) {
  std::uint64_t offset = firstTile;
  const std::uint64_t most = std::min(limits.tiles, limits.memoryBytes / memoryOfTile(layout_));
  while (head_.tiles.size() < most) {
    std::vector<std::uint64_t> chunkOffsets;
    TileRecord tile;
    std::uint64_t next = 0;
    try {
      const Block block = readBlock(*source_, offset, 0, "a tile");
      if (block.type != static_cast<unsigned>(BlockType::Tile)) return;
      ByteReader in(block.content, "a tile", block.contentOffset);
      tile = readTileRecord(in, layout_);
      in.expectEnd();
      next = block.end;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::Io) throw;
      return;  // the tiles before are what there is
    }
    for (const std::uint64_t payload : tile.chunkSizes) {
      chunkOffsets.push_back(next);
      next = saturatingAdd(next, saturatingChunkSize(payload));
    }
    if (next > source_->size()) return;
    tileBlocks_.push_back(offset);
    chunkOffsets_.insert(chunkOffsets_.end(), chunkOffsets.begin(), chunkOffsets.end());
    head_.tiles.push_back(std::move(tile));
    offset = next;
  }
}

void ContainerReader::findMeshBlocks(std::uint64_t& offset) {
  const std::uint64_t start = offset;
  std::vector<std::uint64_t> found;
  while (found.size() < head_.mesh.blocks) {
    const BlockFrame frame =
        readFrame(*source_, offset,
                  "the cells of its mesh; every layer of the points is whole and can be decoded "
                  "with --partial");
    if (frame.type != static_cast<unsigned>(BlockType::Mesh)) {
      throw Error(ErrorCode::Corrupt, "the block at byte " + std::to_string(offset) + " has type " +
                                          std::to_string(frame.type) + " instead of cells");
    }
    found.push_back(offset);
    offset = frame.end;
  }
  meshBlocks_ = std::move(found);
  meshBytes_ = offset - start;
}

MeshBlock ContainerReader::meshBlock(std::size_t number) const {
  const Block block = readBlock(*source_, meshBlocks_[number], 0, "a block of cells");
  ByteReader in(block.content, "a block of cells", block.contentOffset);
  return readMeshBlock(in, head_.mesh.arrays);
}

void ContainerReader::readTrailingBlocks(std::uint64_t offset, std::uint64_t end) const {
  // Every block is at least six bytes long, so this ends.
  bool ended = false;
  while (offset < end) {
    const Block block = readBlock(*source_, offset, 0, "a block behind the chunks");
    if (ended || block.end > end) {
      throw Error(ErrorCode::Corrupt,
                  "the file goes on after its end at byte " + std::to_string(offset));
    }
    if (block.type == static_cast<unsigned>(BlockType::End) && !head_.streaming) {
      if (block.content != Bytes(kEndContent)) {
        throw Error(ErrorCode::Corrupt, "the end block leads to an index that there is not");
      }
      ended = true;
    } else if (block.type >= static_cast<unsigned>(BlockType::Head) &&
               block.type <= static_cast<unsigned>(BlockType::Mesh)) {
      throw Error(ErrorCode::Corrupt, "the block at byte " + std::to_string(offset) + " has type " +
                                          std::to_string(block.type) +
                                          ", which must not stand behind the points");
    } else if (block.type < kOptionalBlock) {
      throw Error(ErrorCode::Unsupported,
                  "the block at byte " + std::to_string(offset) + " has type " +
                      std::to_string(block.type) +
                      ", which this version does not know and may not pass over; use a newer one");
    }
    offset = block.end;
  }
  if (!ended && !head_.streaming) {
    throw Error(ErrorCode::Truncated,
                "the file ends early, at byte " + std::to_string(end) + ", without its end block");
  }
}

std::string ContainerReader::chunkName(std::size_t tile, std::size_t column) const {
  const std::size_t part = layout_.partOf(column);
  std::string of =
      "layer " + std::to_string(layout_.layerOf(column)) + " of tile " + std::to_string(tile);
  if (part == kGeometryPart) return of;
  if (part == kOrderPart) return "the order of the points of tile " + std::to_string(tile);
  const std::size_t array = part - kFirstArrayPart;
  const std::size_t hidden = head_.hiddenArrays();
  if (array < hidden) return "low halves of positions in " + of;
  return "the array \"" + head_.arrays[array - hidden].name + "\" in " + of;
}

std::uint64_t ContainerReader::bytesOfRecord(std::size_t tile) const {
  if (!head_.streaming) return 0;
  ByteWriter record;
  writeTileRecord(record, layout_, head_.tiles[tile]);
  return blockSize(record.data().size());
}

std::uint64_t ContainerReader::bytesOfChunk(std::size_t tile, std::size_t column) const {
  return saturatingChunkSize(head_.tiles[tile].chunkSizes[column]);
}

Bytes ContainerReader::chunk(std::size_t tile, std::size_t column) const {
  return readChunk(*source_, chunkOffsets_[tile * layout_.columns() + column],
                   head_.tiles[tile].chunkSizes[column], chunkName(tile, column));
}

void ContainerReader::checkTileBlock(std::size_t tile) const {
  if (!head_.streaming) return;
  const Block block =
      readBlock(*source_, tileBlocks_[tile], 0, "the record of tile " + std::to_string(tile));
  ByteWriter expected;
  writeTileRecord(expected, layout_, head_.tiles[tile]);
  if (block.type != static_cast<unsigned>(BlockType::Tile) || block.content != expected.data()) {
    throw Error(ErrorCode::Corrupt, "the record of tile " + std::to_string(tile) + " at byte " +
                                        std::to_string(tileBlocks_[tile]) +
                                        " differs from that of the index");
  }
}

}  // namespace bspc::container
