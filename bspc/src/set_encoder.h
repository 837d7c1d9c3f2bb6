#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "shared_progress.h"
#include "tile_encoder.h"
#include "tiling/tile_cut.h"

namespace bspc {

/// Cuts grid points into tiles, codes them on several threads and hands them to a container.
class SetEncoder {
 public:
  /// All must outlive this; `report` gets tiles, bytes and, if wished, the order. `arrays` has a
  /// tuple for each point of the caller's input.
  SetEncoder(const CodingPlan& plan, const EncodeOptions& options, ArraySource arrays,
             SharedProgress& progress, container::ContainerWriter& writer, EncodeReport& report)
      : arrays_(arrays, plan.arrayEffort, options.keepOrder),
        encoder_(*plan.method, plan.layers, plan.wishes, arrays_),
        tilePoints_(static_cast<std::size_t>(plan.tilePoints)),
        options_(options),
        progress_(progress),
        writer_(writer),
        report_(report) {}

  /// May be called for one part of a set after the other. `sourceIndex`: of each point in the
  /// caller's input, empty if that is its own. `original`: that input, which a lossy coding
  /// compares with; may be null for a lossless one.
  void encode(Span<const GridPoint> points, const std::vector<std::uint64_t>& sourceIndex,
              const PointSetView* original);

  /// The faces that the payload of the last tile's points holds, over its decoded points.
  const Cells& faces() const { return faces_; }

 private:
  /// Decides whether the order of the points is stored for the sake of their arrays.
  void considerOrder(Span<const GridPoint> points);
  void encodePart(std::size_t offset, Span<const GridPoint> points);
  tiling::TileCut cut(Span<const GridPoint> points) const;
  FinishedTile encodeTile(const tiling::TileCut& cut, std::size_t tile, std::size_t offset,
                          Span<const GridPoint> points) const;
  void finish(FinishedTile tile);
  bool needsSources() const;
  /// Input indices of the points of a tile.
  std::vector<std::uint64_t> sourcesOf(const tiling::TileCut& cut, std::size_t tile,
                                       std::size_t offset) const;

  TileArrayEncoder arrays_;
  TileEncoder encoder_;
  std::size_t tilePoints_;
  const EncodeOptions& options_;
  SharedProgress& progress_;
  container::ContainerWriter& writer_;
  EncodeReport& report_;
  const std::vector<std::uint64_t>* sourceIndex_ = nullptr;
  const PointSetView* original_ = nullptr;
  Cells faces_;
};

}  // namespace bspc
