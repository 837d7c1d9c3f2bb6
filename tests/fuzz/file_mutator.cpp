#include "file_mutator.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "container/mesh_record.h"
#include "file_model.h"

namespace bspc::fuzz {

std::uint64_t Random::number(std::uint64_t value) {
  switch (below(7)) {
    case 0:
      return value + 1;
    case 1:
      return value - 1;
    case 2:
      return below(4);
    case 3:
      return (std::uint64_t{1} << below(64)) - below(2);
    case 4:
      return value ^ std::uint64_t{1} << below(40);
    case 5:
      return value * 2;
    default:
      return bits() >> below(64);
  }
}

namespace {

using container::BlockType;
using container::TileRecord;

class Mutator {
 public:
  Mutator(FileModel& model, std::size_t maxSize, Random& random, ByteMutator changeBytes)
      : model_(model), maxSize_(maxSize), random_(random), changeBytes_(changeBytes) {}

  void change() {
    switch (random_.below(16)) {
      case 0:
        changeHead();
        break;
      case 1:
        changeArrays();
        break;
      case 2:
        moveThings();
        break;
      case 3:
      case 4:
      case 5:
        changeRecord();
        break;
      case 6:
      case 7:
      case 8:
        changeBlocks();
        break;
      default:
        changePayload();
        break;
    }
    model_.normalise();
  }

  /// Bytes of a payload or of the content of a block.
  void changeSome(Bytes& bytes) {
    const std::size_t size = bytes.size();
    bytes.resize(std::max(maxSize_, size));
    bytes.resize(changeBytes_(bytes.data(), size, std::max(maxSize_, size)));
  }

 private:
  template <class T>
  void changeNumber(T& value) {
    value = static_cast<T>(random_.number(static_cast<std::uint64_t>(value)));
  }

  TileRecord* anyTile(std::size_t* index = nullptr) {
    if (model_.head.tiles.empty()) return nullptr;
    const auto i = static_cast<std::size_t>(random_.below(model_.head.tiles.size()));
    if (index != nullptr) *index = i;
    return &model_.head.tiles[i];
  }

  Bytes* anyPayload() {
    std::size_t t = 0;
    const TileRecord* tile = anyTile(&t);
    if (tile == nullptr) return nullptr;
    const container::TileLayout layout = model_.head.layout();
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < layout.columns(); ++c) {
      if (tile->hasChunk(layout, c)) columns.push_back(c);
    }
    const auto which = static_cast<std::size_t>(random_.below(columns.size()));
    return columns.empty() ? nullptr : &model_.chunks[t][columns[which]];
  }

  void changePayload() {
    Bytes* payload = anyPayload();
    if (payload != nullptr) changeSome(*payload);
  }

  void changeRecord() {
    TileRecord* tile = anyTile();
    if (tile == nullptr) return;
    const auto k = static_cast<std::size_t>(random_.below(3));
    switch (random_.below(12)) {
      case 0:
      case 1:
        changeNumber(tile->points);
        tile->points = std::max<std::uint64_t>(tile->points, 1);
        break;
      case 2:
      case 3:
        changeNumber(tile->extent[k]);
        break;
      case 4:
        changeNumber(tile->lower[k]);
        break;
      case 5:
        tile->method = static_cast<unsigned>(random_.below(9));
        break;
      case 6:
        tile->version = static_cast<unsigned>(random_.below(3));
        break;
      case 7:
        tile->lacking = static_cast<unsigned>(random_.below(model_.head.layers));
        break;
      case 8:
        changeLayer(*tile);
        break;
      case 9:
        tile->order = static_cast<container::TileOrder>(random_.below(3));
        break;
      case 10:
        tile->layeredArrays = !tile->layeredArrays;
        break;
      default:
        for (container::TileArray& array : tile->arrays) array.needsOrder = random_.oneIn(2);
        break;
    }
    for (std::size_t a = 0; a < 3; ++a)
      tile->extent[a] = std::min(tile->extent[a], ~tile->lower[a]);
  }

  void changeLayer(TileRecord& tile) {
    if (tile.coarse.empty()) return;
    geometry::LayerSummary& layer =
        tile.coarse[static_cast<std::size_t>(random_.below(tile.coarse.size()))];
    if (random_.oneIn(2)) {
      changeNumber(layer.representatives);
    } else {
      changeNumber(layer.spread);
    }
  }

  void changeHead() {
    container::FileHead& head = model_.head;
    switch (random_.below(6)) {
      case 0:
        head.layers = static_cast<unsigned>(1 + random_.below(random_.oneIn(4) ? kMaxLayers : 4));
        break;
      case 1:
        head.streaming = !head.streaming;
        if (head.streaming) head.trailingBlocks = false;
        break;
      case 2:
        if (!head.streaming) head.trailingBlocks = !head.trailingBlocks;
        break;
      case 3:
        head.keepsOrder = !head.keepsOrder;
        for (TileRecord& tile : head.tiles) {
          if (head.keepsOrder && tile.order == container::TileOrder::Unknown) {
            tile.order = container::TileOrder::Decoded;
          }
        }
        break;
      case 4:
        changeGrid(head.grid);
        break;
      default:
        model_.versionMinor = static_cast<unsigned>(random_.below(3));
        break;
    }
  }

  void changeGrid(Grid& grid) {
    const Grid before = grid;
    Grid::Axis& axis = grid.axes[static_cast<std::size_t>(random_.below(3))];
    switch (random_.below(4)) {
      case 0:
        changeNumber(axis.base);
        break;
      case 1:
        grid.scalarType = static_cast<ScalarType>(random_.below(kPositionTypeCount));
        break;
      case 2:
        grid.form = static_cast<Grid::Form>(random_.below(3));
        break;
      default:
        changeNumber(random_.oneIn(2) ? axis.numerator : axis.denominator);
        break;
    }
    try {
      grid.validate();
    } catch (const Error&) {
      grid = before;  // the writer of grids takes valid ones
    }
  }

  void changeArrays() {
    std::vector<ArrayDescription>& arrays =
        random_.oneIn(3) ? model_.head.mesh.arrays : model_.head.arrays;
    if (arrays.empty() || random_.oneIn(8)) {
      ArrayDescription array;
      array.name = "array " + std::to_string(arrays.size());
      arrays.push_back(std::move(array));
      return;
    }
    const auto which = static_cast<std::size_t>(random_.below(arrays.size()));
    ArrayDescription& array = arrays[which];
    switch (random_.below(5)) {
      case 0:
        array.type = static_cast<ScalarType>(random_.below(12));
        break;
      case 1:
        array.components =
            static_cast<std::uint32_t>(1 + random_.below(random_.oneIn(8) ? 65536 : 4));
        array.componentNames.clear();
        break;
      case 2:
        array.semantic = static_cast<Semantic>(random_.below(7));
        break;
      case 3:
        array.tolerance = random_.oneIn(2) ? 0 : 0.5;
        break;
      default:
        arrays.erase(arrays.begin() + static_cast<std::ptrdiff_t>(which));
        break;
    }
  }

  void moveThings() {
    Bytes* one = anyPayload();
    Bytes* other = anyPayload();
    if (one == nullptr || other == nullptr) return;
    std::size_t t = 0;
    const TileRecord tile = *anyTile(&t);
    switch (random_.below(4)) {
      case 0:
        std::swap(*one, *other);
        break;
      case 1:
        *one = Bytes(*other);
        break;
      case 2:
        if (model_.head.tiles.size() > 40) return;
        model_.head.tiles.push_back(tile);
        model_.chunks.push_back(std::vector<Bytes>(model_.chunks[t]));
        break;
      default:
        model_.head.tiles.erase(model_.head.tiles.begin() + static_cast<std::ptrdiff_t>(t));
        model_.chunks.erase(model_.chunks.begin() + static_cast<std::ptrdiff_t>(t));
        break;
    }
  }

  void changeBlocks() {
    if (model_.blocks.empty()) {
      changePayload();
      return;
    }
    const auto which = static_cast<std::size_t>(random_.below(model_.blocks.size()));
    FramedBlock& block = model_.blocks[which];
    if (random_.oneIn(20)) {
      model_.blocks.push_back(FramedBlock(block));
      if (random_.oneIn(2)) model_.blocks.back().type = 128;
    } else if (random_.oneIn(20)) {
      model_.blocks.erase(model_.blocks.begin() + static_cast<std::ptrdiff_t>(which));
    } else if (block.type != static_cast<unsigned>(BlockType::Mesh) || !changeMesh(block.content)) {
      changeSome(block.content);
    }
    std::uint64_t meshes = 0;
    for (const FramedBlock& b : model_.blocks) {
      if (b.type == static_cast<unsigned>(BlockType::Mesh)) ++meshes;
    }
    model_.head.mesh.blocks = meshes;
  }

  /// False if the block cannot be read.
  bool changeMesh(Bytes& content) {
    container::MeshBlock block;
    try {
      container::ByteReader in(content, "cells", 0);
      block = container::readMeshBlock(in, model_.head.mesh.arrays);
    } catch (const Error&) {
      return false;
    }
    const container::CellCounts before = block.counts;
    switch (random_.below(12)) {
      case 0:
        changeNumber(block.counts.vertices);
        break;
      case 1:
        changeNumber(block.counts.lines);
        break;
      case 2:
        changeNumber(block.counts.faces);
        break;
      case 3:
        changeNumber(random_.oneIn(2) ? block.firstTile : block.tiles);
        break;
      case 4:
      case 5:
        if (!block.arrays.empty()) {
          changeSome(
              block.arrays[static_cast<std::size_t>(random_.below(block.arrays.size()))].payload);
          break;
        }
        [[fallthrough]];
      default:
        changeSome(block.cells);
        break;
    }
    container::CellCounts& all = model_.head.mesh.counts;
    all.vertices += block.counts.vertices - before.vertices;
    all.lines += block.counts.lines - before.lines;
    all.faces += block.counts.faces - before.faces;
    content = container::writeMeshBlock(block, model_.head.mesh.arrays);
    return true;
  }

  FileModel& model_;
  std::size_t maxSize_;
  Random& random_;
  ByteMutator changeBytes_;
};

Bytes changedAnywhere(ByteView file, std::size_t maxSize, ByteMutator changeBytes) {
  Bytes bytes(file.begin(), file.end());
  bytes.resize(std::max(maxSize, file.size()));
  bytes.resize(changeBytes(bytes.data(), file.size(), bytes.size()));
  return bytes;
}

}  // namespace

Bytes mutateFile(ByteView file, std::size_t maxSize, Random& random, ByteMutator changeBytes) {
  std::optional<FileModel> model = takeApart(file);
  if (!model || random.oneIn(32)) return changedAnywhere(file, maxSize, changeBytes);
  Mutator mutator(*model, maxSize, random, changeBytes);
  // A block as bytes, which may say what no record can.
  const bool rawBlock = random.oneIn(8);
  if (!rawBlock) {
    const std::uint64_t changes = 1 + (random.oneIn(3) ? random.below(4) : 0);
    for (std::uint64_t i = 0; i < changes; ++i) mutator.change();
  }
  std::vector<Piece> pieces = piecesOf(std::move(*model));
  if (rawBlock) {
    std::vector<Piece*> blocks;
    for (Piece& piece : pieces) {
      if (piece.kind == Piece::Kind::Block) blocks.push_back(&piece);
    }
    Piece& chosen = random.oneIn(2)
                        ? *blocks.front()
                        : *blocks[static_cast<std::size_t>(random.below(blocks.size()))];
    mutator.changeSome(chosen.content);
  }
  Bytes changed = putTogether(pieces);
  if (changed.size() > maxSize) changed.resize(maxSize);
  return changed;
}

}  // namespace bspc::fuzz
