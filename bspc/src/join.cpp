#include "bspc/join.h"

#include <algorithm>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "container/container_reader.h"
#include "container/container_writer.h"
#include "joined_head.h"
#include "progress_scale.h"
#include "saturating.h"

namespace bspc {

namespace {

/// A tile of one of the files.
struct SourceTile {
  std::size_t file = 0;
  std::size_t index = 0;
};

class Joiner {
 public:
  Joiner(const std::vector<std::shared_ptr<ByteSource>>& files, const JoinOptions& options)
      : options_(options), progress_(options.progress, 0, 1) {
    for (const std::shared_ptr<ByteSource>& source : files) open(source);
    const bool empty = points_ == 0;
    for (std::size_t f = 0; f < files_.size(); ++f) {
      // A file without points puts no demand on the grid.
      if (empty || !files_[f]->tiles().empty()) {
        takeGrid(f);
        tables_.take(f, files_[f]->head());
      }
      metadata_.take(f, files_[f]->head().metadata);
      head_.layers = std::max(head_.layers, files_[f]->head().layers);
    }
    head_.arrays = tables_.arrays();
    head_.keepsOrder = tables_.keepsOrder();
    head_.metadata = metadata_.metadata();
    layout_ = head_.layout();
    for (std::size_t f = 0; f < files_.size(); ++f) {
      meshes_.take(f, head_.tiles.size(), files_[f]->head().mesh);
      takeTiles(f);
    }
    head_.mesh = meshes_.record();
  }

  JoinReport write(ByteSink& sink) {
    JoinReport report;
    report.grid = head_.grid;
    report.layers = head_.layers;
    report.tiles = tiles_.size();
    report.points = points_;
    report.droppedMetadata = metadata_.dropped();
    report.fileBytes =
        options_.layout == Layout::Streaming ? writeStreaming(sink) : writeProgressive(sink);
    progress_.report(1);
    return report;
  }

 private:
  void open(const std::shared_ptr<ByteSource>& source) {
    OpenOptions open;
    open.limits = options_.limits;
    files_.push_back(std::make_unique<container::ContainerReader>(source, open));
    for (const container::TileRecord& tile : files_.back()->tiles()) {
      points_ = saturatingAdd(points_, tile.points);
    }
  }

  void takeGrid(std::size_t file) {
    const Grid& grid = files_[file]->head().grid;
    if (!hasGrid_) {
      head_.grid = grid;
      hasGrid_ = true;
      return;
    }
    if (!grid.sameLattice(head_.grid) || grid.scalarType != head_.grid.scalarType) {
      throw Error(ErrorCode::InvalidArgument,
                  "file " + std::to_string(file) +
                      " has another grid than those before it; encode it anew with --grid and the "
                      "name of the first (GridRequest::onGrid in the library)");
    }
    for (std::size_t k = 0; k < 3; ++k) {
      head_.grid.axes[k].base = std::min(head_.grid.axes[k].base, grid.axes[k].base);
    }
  }

  void takeTiles(std::size_t f) {
    const container::ContainerReader& file = *files_[f];
    for (std::size_t i = 0; i < file.tiles().size(); ++i) {
      container::TileRecord tile = file.tiles()[i];
      for (std::size_t k = 0; k < 3; ++k) {
        // Bases lie within 2^62 of zero, so their distance fits.
        const std::uint64_t shift = static_cast<std::uint64_t>(file.head().grid.axes[k].base) -
                                    static_cast<std::uint64_t>(head_.grid.axes[k].base);
        const std::uint64_t top =
            saturatingAdd(shift, tile.lower[k] + std::uint64_t{tile.extent[k]});
        if (top > std::numeric_limits<std::uint32_t>::max()) {
          throw Error(ErrorCode::OutOfGrid,
                      std::string("the files together extend over more than the 2^32 steps that a "
                                  "grid has along ") +
                          "xyz"[k] + "; join fewer, or encode them with a coarser precision");
        }
        tile.lower[k] += static_cast<std::uint32_t>(shift);
      }
      rearrange(tile, f);
      head_.tiles.push_back(std::move(tile));
      tiles_.push_back({f, i});
    }
  }

  /// Puts the chunks of a tile into the columns of the joined file.
  void rearrange(container::TileRecord& tile, std::size_t f) {
    // An order that nothing needs is left behind.
    const bool needsOrder =
        head_.keepsOrder || std::any_of(tile.arrays.begin(), tile.arrays.end(),
                                        [](const auto& array) { return array.needsOrder; });
    if (!needsOrder && tile.order == container::TileOrder::Stored) {
      tile.order = container::TileOrder::Unknown;
    }
    const unsigned more = head_.layers - files_[f]->head().layers;
    tile.addLacking(more);
    std::vector<container::TileArray> arrays;
    for (std::size_t a = 0; a < layout_.arrays.size(); ++a) {
      arrays.push_back(tile.arrays[sourceArray(f, a)]);
    }
    tile.arrays = std::move(arrays);
    std::vector<std::uint64_t> sizes(layout_.columns(), container::kNoChunk);
    for (std::size_t column = 0; column < sizes.size(); ++column) {
      if (tile.hasChunk(layout_, column)) sizes[column] = tile.chunkSizes[sourceColumn(f, column)];
    }
    tile.chunkSizes = std::move(sizes);
  }

  /// Where an array of the joined layout stands in that of a file.
  std::size_t sourceArray(std::size_t f, std::size_t array) const {
    const std::size_t hidden = head_.hiddenArrays();
    return array < hidden ? array : hidden + tables_.indexIn(f, array - hidden);
  }

  /// The column of a file that a column of the joined one comes from.
  std::size_t sourceColumn(std::size_t f, std::size_t column) const {
    const container::TileLayout& source = files_[f]->layout();
    std::size_t part = layout_.partOf(column);
    if (part >= container::kFirstArrayPart) {
      part = container::kFirstArrayPart + sourceArray(f, part - container::kFirstArrayPart);
    }
    return source.column(layout_.layerOf(column) - (head_.layers - source.layers), part);
  }

  /// The payload of a chunk in a column of the joined file, which the tile has.
  Bytes payload(std::size_t tile, std::size_t column) {
    const SourceTile& source = tiles_[tile];
    return files_[source.file]->chunk(source.index, sourceColumn(source.file, column));
  }

  std::uint64_t writeProgressive(ByteSink& sink) {
    std::size_t done = 0;
    const auto all =
        static_cast<double>(std::max<std::size_t>(tiles_.size() * layout_.columns(), 1));
    return container::writeProgressive(
        sink, head_,
        [&](std::size_t tile, std::size_t column) {
          progress_.report(static_cast<double>(done++) / all);
          return payload(tile, column);
        },
        [this](std::size_t block) { return meshBlock(block); });
  }

  /// The content of a Mesh block, for the tiles that it has in the joined file.
  Bytes meshBlock(std::size_t number) const {
    const JoinedMeshes::Source& source = meshes_.source(number);
    container::MeshBlock block = files_[source.file]->meshBlock(source.block);
    block.firstTile = saturatingAdd(block.firstTile, source.firstTile);
    return container::writeMeshBlock(block, head_.mesh.arrays);
  }

  std::uint64_t writeStreaming(ByteSink& sink) {
    container::FileHead head = head_;
    head.tiles.clear();
    container::ContainerWriter writer(sink, Layout::Streaming, std::move(head));
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      progress_.report(static_cast<double>(tile) / static_cast<double>(tiles_.size()));
      files_[tiles_[tile].file]->checkTileBlock(tiles_[tile].index);
      std::vector<Bytes> chunks;
      for (std::size_t column = 0; column < layout_.columns(); ++column) {
        if (head_.tiles[tile].hasChunk(layout_, column)) chunks.push_back(payload(tile, column));
      }
      writer.addTile(head_.tiles[tile], std::move(chunks));
    }
    writer.finish([this](std::size_t block) { return meshBlock(block); });
    return writer.bytesWritten();
  }

  const JoinOptions& options_;
  ProgressScale progress_;
  std::vector<std::unique_ptr<container::ContainerReader>> files_;
  std::uint64_t points_ = 0;
  bool hasGrid_ = false;
  JoinedTables tables_;
  JoinedMetadata metadata_;
  JoinedMeshes meshes_;
  container::FileHead head_;
  container::TileLayout layout_;
  std::vector<SourceTile> tiles_;
};

}  // namespace

JoinReport join(const std::vector<std::shared_ptr<ByteSource>>& files, ByteSink& sink,
                const JoinOptions& options) {
  if (files.empty()) throw Error(ErrorCode::InvalidArgument, "there are no files to join");
  return Joiner(files, options).write(sink);
}

}  // namespace bspc
