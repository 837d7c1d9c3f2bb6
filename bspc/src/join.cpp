#include "bspc/join.h"

#include <algorithm>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "container/container_reader.h"
#include "container/container_writer.h"
#include "progress_scale.h"
#include "saturating.h"

namespace bspc {

namespace {

/// A tile of one of the files.
struct SourceTile {
  const container::ContainerReader* file = nullptr;
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
      if (empty || !files_[f]->tiles().empty()) takeGrid(f);
      head_.layers = std::max(head_.layers, files_[f]->head().layers);
    }
    for (const auto& file : files_) takeTiles(*file);
  }

  JoinReport write(ByteSink& sink) {
    JoinReport report;
    report.grid = head_.grid;
    report.layers = head_.layers;
    report.tiles = tiles_.size();
    report.points = points_;
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

  void takeTiles(const container::ContainerReader& file) {
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
      tile.addLacking(head_.layers - file.head().layers);
      head_.tiles.push_back(std::move(tile));
      tiles_.push_back({&file, i});
    }
  }

  /// The payload of a chunk in a column of the joined file, which the tile has.
  Bytes payload(std::size_t tile, std::size_t column) {
    const SourceTile& source = tiles_[tile];
    return source.file->chunk(source.index, column - (head_.layers - source.file->head().layers));
  }

  std::uint64_t writeProgressive(ByteSink& sink) {
    std::size_t done = 0;
    const auto all = static_cast<double>(std::max<std::size_t>(tiles_.size() * head_.layers, 1));
    return container::writeProgressive(sink, head_, [&](std::size_t tile, std::size_t column) {
      progress_.report(static_cast<double>(done++) / all);
      return payload(tile, column);
    });
  }

  std::uint64_t writeStreaming(ByteSink& sink) {
    container::ContainerWriter writer(sink, Layout::Streaming, head_.grid, head_.layers);
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      progress_.report(static_cast<double>(tile) / static_cast<double>(tiles_.size()));
      tiles_[tile].file->checkTileBlock(tiles_[tile].index);
      std::vector<Bytes> chunks;
      for (unsigned l = head_.tiles[tile].lacking; l < head_.layers; ++l) {
        chunks.push_back(payload(tile, l));
      }
      writer.addTile(head_.tiles[tile], std::move(chunks));
    }
    writer.finish();
    return writer.bytesWritten();
  }

  const JoinOptions& options_;
  ProgressScale progress_;
  std::vector<std::unique_ptr<container::ContainerReader>> files_;
  std::uint64_t points_ = 0;
  bool hasGrid_ = false;
  container::FileHead head_;
  std::vector<SourceTile> tiles_;
};

}  // namespace

JoinReport join(const std::vector<std::shared_ptr<ByteSource>>& files, ByteSink& sink,
                const JoinOptions& options) {
  if (files.empty()) throw Error(ErrorCode::InvalidArgument, "there are no files to join");
  return Joiner(files, options).write(sink);
}

}  // namespace bspc
