#include <optional>
#include <utility>

#include "bspc/error.h"
#include "connectivity/connectivity_coder.h"
#include "container/checksum.h"
#include "file_model.h"
#include "fuzz_limits.h"
#include "geometry/surface/surface_method.h"
#include "mesh/mesh_encoder.h"

namespace bspc::fuzz {

namespace {

using container::TileRecord;

/// Decodes what there is of a file, as a decoder does that trusts it, and corrects what the file
/// says of it.
class ContentRepair {
 public:
  explicit ContentRepair(FileModel& model) : model_(model), layout_(model.head.layout()) {}

  void repair() {
    for (std::size_t t = 0; t < model_.head.tiles.size(); ++t) repairTile(t);
    // Cells are decoded over points in the order of the decoder.
    if (decodedTiles_ < model_.head.tiles.size() || model_.head.keepsOrder) return;
    model_.head.mesh.counts = {};
    for (FramedBlock& block : model_.blocks) {
      if (block.type == static_cast<unsigned>(container::BlockType::Mesh)) repairMesh(block);
    }
  }

 private:
  const Bytes& payload(std::size_t tile, unsigned layer) const {
    return model_.chunks[tile][layout_.column(layer, container::kGeometryPart)];
  }

  void repairTile(std::size_t t) {
    const DecodeLimits limits = smallLimits();
    TileRecord& record = model_.head.tiles[t];
    const auto* method = geometry::findGeometryMethod(static_cast<Method>(record.method));
    if (method == nullptr || record.version > method->version()) return;
    geometry::TileToDecode tile;
    tile.version = record.version;
    tile.points = record.points;
    tile.extent = record.extent;
    tile.layers = model_.head.layers - record.lacking;
    for (unsigned l = record.lacking; l < model_.head.layers; ++l) {
      tile.payloads.emplace_back(payload(t, l));
    }
    tile.maxPoints = limits.points;
    tile.maxBytes = limits.memoryBytes;
    tile.maxDepth = limits.depth;
    try {
      const geometry::DecodedTile decoded = method->decode(tile, [](std::uint64_t) {});
      if (decoded.points.size() != record.points) return;
      record.contentChecksum = container::contentChecksum(decoded.points);
      for (GridPoint point : decoded.points) {
        for (std::size_t k = 0; k < 3; ++k) point[k] += record.lower[k];
        points_.push_back(point);
      }
      ++decodedTiles_;
    } catch (const Error&) {
      return;
    }
  }

  /// Only of a block of all tiles.
  void repairMesh(FramedBlock& framed) {
    container::MeshRecord& mesh = model_.head.mesh;
    try {
      container::ByteReader in(framed.content, "cells", 0);
      container::MeshBlock block = container::readMeshBlock(in, mesh.arrays);
      const bool whole = block.firstTile == 0 && block.tiles == model_.head.tiles.size();
      if (whole) {
        const MeshCells cells = connectivity::decodeMesh(
            {points_, stepsOf(model_.head.grid)}, block.cells, smallLimits().memoryBytes,
            [&](std::uint64_t memory) { return facesOfTile(memory); });
        block.counts = {cells.vertices.size(), cells.lines.size(), cells.faces.size()};
        block.contentChecksum = container::cellsChecksum(cells);
        framed.content = container::writeMeshBlock(block, mesh.arrays);
      }
      mesh.counts.add(block.counts);
    } catch (const Error&) {
      return;
    }
  }

  Cells facesOfTile(std::uint64_t memory) const {
    if (model_.head.tiles.size() != 1) throw Error(ErrorCode::Corrupt, "several tiles");
    return geometry::facesOfSurface(payload(0, model_.head.layers - 1), points_.size(), memory);
  }

  FileModel& model_;
  container::TileLayout layout_;
  std::vector<GridPoint> points_;
  std::size_t decodedTiles_ = 0;
};

}  // namespace

Bytes withRightContents(ByteView file) {
  std::optional<FileModel> model = takeApart(file);
  if (!model) return {};
  ContentRepair(*model).repair();
  return putTogether(piecesOf(std::move(*model)));
}

}  // namespace bspc::fuzz
