#include "mesh/mesh_decoder.h"

#include <limits>
#include <string>
#include <utility>

#include "attributes/array_coder.h"
#include "bspc/error.h"
#include "connectivity/connectivity_coder.h"
#include "container/checksum.h"
#include "geometry/surface/surface_method.h"
#include "mesh/mesh_encoder.h"

namespace bspc {

namespace {

constexpr std::uint64_t kMostNumbers = std::numeric_limits<std::uint32_t>::max() - 16;

std::uint64_t bytesOf(const MeshCells& cells) {
  std::uint64_t bytes = 0;
  for (const Cells* sort : {&cells.vertices, &cells.lines, &cells.faces}) {
    bytes += 4 * (std::uint64_t{sort->indices.capacity()} + sort->ends.capacity());
  }
  return bytes;
}

/// Appends cells whose points are counted from `first` on.
void append(const Cells& from, std::uint64_t first, Cells& to) {
  if (to.indices.size() + from.indices.size() > kMostNumbers) {
    throw Error(ErrorCode::Unsupported,
                "the joined file has more than 2^32 corners of cells; decode its parts");
  }
  const auto start = static_cast<std::uint32_t>(to.indices.size());
  for (const std::uint32_t i : from.indices) {
    to.indices.push_back(i + static_cast<std::uint32_t>(first));
  }
  for (const std::uint32_t end : from.ends) to.ends.push_back(start + end);
}

class Reader {
 public:
  Reader(const container::ContainerReader& file, std::uint64_t memory,
         const std::function<void(double)>& working, DecodedPoints& points)
      : file_(file), memory_(memory), working_(working), points_(points) {}

  void read() {
    if (points_.points.size() > kMostNumbers) {
      throw Error(ErrorCode::Unsupported,
                  "the file has cells and more than 2^32 points; decode its parts, or without "
                  "cells");
    }
    const container::MeshRecord& mesh = file_.head().mesh;
    arrays_.resize(mesh.arrays.size());
    container::CellCounts counts;
    for (std::uint64_t i = 0; i < mesh.blocks; ++i) {
      const container::MeshBlock block = file_.meshBlock(i);
      counts.add(block.counts);
      readBlock(block);
    }
    if (counts.vertices != mesh.counts.vertices || counts.lines != mesh.counts.lines ||
        counts.faces != mesh.counts.faces) {
      throw Error(ErrorCode::Corrupt, "the file has other cells than its head says");
    }
    takeArrays();
  }

 private:
  void readBlock(const container::MeshBlock& block) {
    // Tiles of blocks ascend, so that points are counted but once.
    if (block.firstTile < nextTile_ || block.firstTile > file_.tiles().size() ||
        block.tiles > file_.tiles().size() - block.firstTile) {
      throw Error(ErrorCode::Corrupt, "the cells are of tiles that the file does not have");
    }
    for (; nextTile_ < block.firstTile; ++nextTile_) firstPoint_ += file_.tiles()[nextTile_].points;
    std::uint64_t count = 0;
    for (; nextTile_ < block.firstTile + block.tiles; ++nextTile_) {
      count += file_.tiles()[nextTile_].points;
    }
    const Span<const GridPoint> own =
        Span<const GridPoint>(points_.points)
            .subspan(static_cast<std::size_t>(firstPoint_), static_cast<std::size_t>(count));
    const MeshCells cells = connectivity::decodeMesh(
        {own, stepsOf(file_.head().grid)}, block.cells, memoryLeft(),
        [&](std::uint64_t memory) { return facesOfTile(block, memory); },
        [&](std::uint64_t done) { report(done); });
    done_ += cells.vertices.size() + cells.lines.size() + cells.faces.size();
    if (cells.vertices.size() != block.counts.vertices ||
        cells.lines.size() != block.counts.lines || cells.faces.size() != block.counts.faces) {
      throw Error(ErrorCode::Corrupt, "a block of cells has others than it says");
    }
    if (container::cellsChecksum(cells) != block.contentChecksum) {
      failContent("cells of the mesh");
    }
    readArrays(block, own, cells);
    if (bytesOf(points_.mesh) + 2 * bytesOf(cells) > memory_) failLimit();
    append(cells.vertices, firstPoint_, points_.mesh.vertices);
    append(cells.lines, firstPoint_, points_.mesh.lines);
    append(cells.faces, firstPoint_, points_.mesh.faces);
    firstPoint_ += count;
  }

  /// The faces that the points of the block's only tile were coded along.
  Cells facesOfTile(const container::MeshBlock& block, std::uint64_t memory) const {
    const auto tile = static_cast<std::size_t>(block.firstTile);
    if (block.tiles != 1 || file_.head().keepsOrder ||
        file_.tiles()[tile].method != static_cast<unsigned>(Method::Surface)) {
      throw Error(ErrorCode::Corrupt, "the faces are those of a tile that has none");
    }
    const std::size_t column =
        file_.layout().column(file_.head().layers - 1, container::kGeometryPart);
    return geometry::facesOfSurface(file_.chunk(tile, column), file_.tiles()[tile].points, memory,
                                    [&] { report(0); });
  }

  /// `more` cells are done of the block at hand.
  void report(std::uint64_t more) const {
    const container::CellCounts& all = file_.head().mesh.counts;
    const double cells = static_cast<double>(all.vertices) + static_cast<double>(all.lines) +
                         static_cast<double>(all.faces);
    working_(cells > 0 ? static_cast<double>(done_ + more) / cells : 1);
  }

  std::uint64_t memoryLeft() const {
    const std::uint64_t used = bytesOf(points_.mesh) + arrayBytes_;
    return memory_ > used ? memory_ - used : 0;
  }

  [[noreturn]] void failLimit() const {
    throw Error(ErrorCode::LimitExceeded,
                "decoding the cells needs more memory than the limit; "
                "raise it if the file is to be trusted");
  }

  [[noreturn]] static void failContent(const std::string& what) {
    throw Error(ErrorCode::Corrupt,
                "the " + what +
                    " are not those that were written (wrong content checksum): the file is "
                    "damaged, or this machine does not calculate as it should");
  }

  void readArrays(const container::MeshBlock& block, Span<const GridPoint> own,
                  const MeshCells& cells) {
    if (arrays_.empty()) return;
    const std::vector<GridPoint> centres =
        cellCentres(std::vector<GridPoint>(own.begin(), own.end()), cells);
    attributes::TilePoints places(centres);
    cellsOf_.push_back({cells.vertices.size(), cells.lines.size(), cells.faces.size()});
    for (std::size_t a = 0; a < arrays_.size(); ++a) {
      const ArrayDescription& description = file_.head().mesh.arrays[a];
      report(0);
      attributes::ArrayValues values;
      const attributes::ArrayShape shape{description.type, description.components,
                                         description.semantic};
      attributes::decodeArray(shape, block.arrays[a].payload, places, memoryLeft(), values);
      if (container::valuesChecksum(shape, values, centres.size()) !=
          block.arrays[a].contentChecksum) {
        failContent("values of the array \"" + description.name + "\" beside the cells");
      }
      arrayBytes_ += values.numbers.size() + values.strings.size() * sizeof(std::string);
      arrays_[a].push_back(std::move(values));
    }
  }

  /// Of several blocks, all vertex cells come first, then all lines, then all faces.
  void takeArrays() {
    for (std::size_t a = 0; a < arrays_.size(); ++a) {
      ArrayValues array;
      static_cast<ArrayDescription&>(array) = file_.head().mesh.arrays[a];
      const std::size_t tuple = array.type == ScalarType::String
                                    ? array.components
                                    : array.components * arrayValueSize(array.type);
      for (std::size_t sort = 0; sort < 3; ++sort) {
        for (std::size_t b = 0; b < arrays_[a].size(); ++b) {
          std::size_t first = 0;
          for (std::size_t s = 0; s < sort; ++s) first += cellsOf_[b][s];
          takeTuples(arrays_[a][b], first * tuple, cellsOf_[b][sort] * tuple, array);
        }
      }
      points_.cellArrays.push_back(std::move(array));
    }
  }

  static void takeTuples(const attributes::ArrayValues& from, std::size_t first, std::size_t count,
                         ArrayValues& to) {
    if (to.type == ScalarType::String) {
      to.strings.insert(to.strings.end(), from.strings.begin() + static_cast<std::ptrdiff_t>(first),
                        from.strings.begin() + static_cast<std::ptrdiff_t>(first + count));
    } else {
      to.values.insert(to.values.end(), from.numbers.begin() + static_cast<std::ptrdiff_t>(first),
                       from.numbers.begin() + static_cast<std::ptrdiff_t>(first + count));
    }
  }

  const container::ContainerReader& file_;
  std::uint64_t memory_;
  const std::function<void(double)>& working_;
  DecodedPoints& points_;
  std::uint64_t done_ = 0;  ///< cells of the blocks before
  std::uint64_t nextTile_ = 0;
  std::uint64_t firstPoint_ = 0;
  std::uint64_t arrayBytes_ = 0;
  std::vector<std::vector<attributes::ArrayValues>> arrays_;  ///< by array, then by block
  std::vector<std::array<std::size_t, 3>> cellsOf_;           ///< cells of each sort, by block
};

}  // namespace

void decodeMesh(const container::ContainerReader& file, std::uint64_t memory,
                const std::function<void(double)>& working, DecodedPoints& points) {
  Reader(file, memory, working, points).read();
}

}  // namespace bspc
