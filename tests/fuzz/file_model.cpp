#include "file_model.h"

#include <algorithm>
#include <utility>

#include "bspc/error.h"
#include "bspc/io.h"
#include "container/checksum.h"
#include "fuzz_limits.h"

namespace bspc::fuzz {

namespace {

using container::BlockFrame;
using container::BlockType;
using container::ByteReader;
using container::ByteWriter;
using container::TileRecord;

/// Takes the bytes behind the head apart, as far as they go.
class Tail {
 public:
  Tail(ByteView file, std::size_t offset, FileModel& model)
      : file_(file), offset_(offset), model_(model), layout_(model.head.layout()) {}

  void takeProgressive() {
    model_.chunks.assign(model_.head.tiles.size(), std::vector<Bytes>(layout_.columns()));
    for (std::size_t column = 0; column < layout_.columns(); ++column) {
      for (std::size_t tile = 0; tile < model_.head.tiles.size(); ++tile) {
        takeChunk(model_.head.tiles[tile].chunkSizes[column], model_.chunks[tile][column]);
      }
    }
    takeBlocks();
  }

  void takeBlocks() {
    MemorySource source(file_);
    try {
      while (offset_ < file_.size()) {
        const BlockFrame frame = container::readFrame(source, offset_, "a block");
        const ByteView content = file_.subspan(static_cast<std::size_t>(frame.contentOffset),
                                               static_cast<std::size_t>(frame.content));
        offset_ = static_cast<std::size_t>(frame.end);
        takeBlock(frame.type, content);
      }
    } catch (const Error&) {
      return;  // what goes before counts
    }
  }

 private:
  void takeBlock(unsigned type, ByteView content) {
    switch (static_cast<BlockType>(type)) {
      case BlockType::Tile: {
        if (!model_.head.streaming) break;
        ByteReader in(content, "a tile", 0);
        model_.head.tiles.push_back(container::readTileRecord(in, layout_));
        const TileRecord& record = model_.head.tiles.back();
        std::vector<Bytes>& chunks = model_.chunks.emplace_back(layout_.columns());
        for (std::size_t column = 0; column < layout_.columns(); ++column) {
          takeChunk(record.chunkSizes[column], chunks[column]);
        }
        return;
      }
      case BlockType::Index:
      case BlockType::End:
        return;  // made anew
      default:
        break;
    }
    model_.blocks.push_back({type, Bytes(content.begin(), content.end())});
  }

  void takeChunk(std::uint64_t size, Bytes& payload) {
    if (size == container::kNoChunk) return;
    const std::uint64_t left = file_.size() - offset_;
    const auto taken = static_cast<std::size_t>(std::min(size, left));
    const ByteView bytes = file_.subspan(offset_, taken);
    payload.assign(bytes.begin(), bytes.end());
    offset_ += taken;
    offset_ += std::min<std::size_t>(container::checksumWidth(size), file_.size() - offset_);
  }

  ByteView file_;
  std::size_t offset_;
  FileModel& model_;
  container::TileLayout layout_;
};

void addChunks(const FileModel& model, const container::TileLayout& layout, std::size_t tile,
               std::size_t column, std::vector<Piece>& pieces) {
  if (!model.head.tiles[tile].hasChunk(layout, column)) return;
  pieces.push_back({Piece::Kind::Chunk, 0, model.chunks[tile][column]});
}

void addBlocks(const FileModel& model, std::vector<Piece>& pieces) {
  for (const FramedBlock& block : model.blocks) {
    pieces.push_back({Piece::Kind::Block, block.type, block.content});
  }
}

Bytes recordOf(const container::TileLayout& layout, const TileRecord& tile) {
  ByteWriter out;
  container::writeTileRecord(out, layout, tile);
  return out.take();
}

}  // namespace

void FileModel::normalise() {
  const container::TileLayout layout = head.layout();
  chunks.resize(head.tiles.size());
  for (std::size_t t = 0; t < head.tiles.size(); ++t) {
    TileRecord& tile = head.tiles[t];
    tile.lacking = std::min(tile.lacking, head.layers - 1);
    tile.coarse.resize(head.layers - 1);
    tile.arrays.resize(layout.arrays.size());
    chunks[t].resize(layout.columns());
    tile.chunkSizes.assign(layout.columns(), container::kNoChunk);
    for (std::size_t c = 0; c < layout.columns(); ++c) {
      if (tile.hasChunk(layout, c)) tile.chunkSizes[c] = chunks[t][c].size();
    }
  }
}

std::optional<FileModel> takeApart(ByteView file) {
  if (file.size() < container::kPreambleSize ||
      !std::equal(container::kSignature.begin(), container::kSignature.end(), file.begin())) {
    return std::nullopt;
  }
  FileModel model;
  model.versionMinor = file[container::kPreambleSize - 1];
  try {
    MemorySource source(file);
    const BlockFrame frame = container::readFrame(source, container::kPreambleSize, "the head");
    if (frame.type != static_cast<unsigned>(BlockType::Head)) return std::nullopt;
    ByteReader in(file.subspan(static_cast<std::size_t>(frame.contentOffset),
                               static_cast<std::size_t>(frame.content)),
                  "the head", 0);
    model.head = container::readHead(in, smallLimits());
    Tail tail(file, static_cast<std::size_t>(frame.end), model);
    if (model.head.streaming) {
      tail.takeBlocks();
    } else {
      tail.takeProgressive();
    }
  } catch (const Error&) {
    return std::nullopt;
  }
  return model;
}

std::vector<Piece> piecesOf(FileModel model) {
  model.normalise();
  const container::TileLayout layout = model.head.layout();
  Bytes preamble(container::kSignature.begin(), container::kSignature.end());
  preamble.push_back(container::kVersionMajor);
  preamble.push_back(static_cast<std::uint8_t>(model.versionMinor));
  std::vector<Piece> pieces;
  pieces.push_back({Piece::Kind::Raw, 0, std::move(preamble)});
  const auto addBlock = [&](BlockType type, Bytes content) {
    pieces.push_back({Piece::Kind::Block, static_cast<unsigned>(type), std::move(content)});
  };
  addBlock(BlockType::Head, container::writeHead(model.head));
  if (model.head.streaming) {
    ByteWriter table;
    container::writeTileTable(table, layout, model.head.tiles);
    for (std::size_t t = 0; t < model.head.tiles.size(); ++t) {
      addBlock(BlockType::Tile, recordOf(layout, model.head.tiles[t]));
      for (std::size_t c = 0; c < layout.columns(); ++c) addChunks(model, layout, t, c, pieces);
    }
    addBlocks(model, pieces);
    addBlock(BlockType::Index, table.take());
    pieces.push_back({Piece::Kind::EndBlock, 0, {}});
    return pieces;
  }
  for (std::size_t c = 0; c < layout.columns(); ++c) {
    for (std::size_t t = 0; t < model.head.tiles.size(); ++t) {
      addChunks(model, layout, t, c, pieces);
    }
  }
  addBlocks(model, pieces);
  if (model.head.trailingBlocks) addBlock(BlockType::End, Bytes(container::kEndContent));
  return pieces;
}

Bytes putTogether(const std::vector<Piece>& pieces) {
  Bytes file;
  std::uint64_t indexOffset = 0;
  const auto append = [&](const Bytes& bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  };
  for (const Piece& piece : pieces) {
    const auto type = static_cast<BlockType>(piece.type);
    switch (piece.kind) {
      case Piece::Kind::Raw:
        append(piece.content);
        break;
      case Piece::Kind::Chunk:
        append(container::makeChunk(piece.content));
        break;
      case Piece::Kind::Block:
        if (type == BlockType::Index) indexOffset = file.size();
        append(container::makeBlock(type, piece.content,
                                    type == BlockType::Head ? ByteView(file) : ByteView()));
        break;
      case Piece::Kind::EndBlock: {
        ByteWriter end;
        end.unsignedLittle(indexOffset, container::kEndContent);
        append(container::makeBlock(BlockType::End, end.data()));
        break;
      }
    }
  }
  return file;
}

}  // namespace bspc::fuzz
