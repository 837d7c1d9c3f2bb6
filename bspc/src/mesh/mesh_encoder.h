#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/grid.h"
#include "bspc/point_set.h"
#include "container/mesh_record.h"

namespace bspc {

/// Codes the cells of a point set's mesh, once the order of its points is known.
class MeshEncoder {
 public:
  /// All must outlive this. Throws Error(InvalidArgument) for cells of points that there are not,
  /// arrays that do not fit, or wishes that a mesh cannot be coded with.
  MeshEncoder(const PointSetView& points, const EncodeOptions& options);

  /// Whether there is anything to code.
  bool hasWork() const { return mesh_ != nullptr; }
  /// What the head says.
  container::MeshRecord record() const;

  /// The content of the Mesh block. `order`: input index of each point that a decoder returns;
  /// entries of points at the same place may be exchanged. `fit`: their grid points. `report` gets
  /// what the mesh takes. Throws Error(InvalidArgument) if cells use points that were dropped.
  /// `surface`: faces that a decoder knows from its points on, over those; null if it does not.
  Bytes encode(const GridFit& fit, unsigned effort, std::uint64_t tiles, const Cells* surface,
               std::vector<std::uint64_t>& order, EncodeReport& report) const;

  /// The faces that are an oriented surface, which method surface goes along. `order`: input index
  /// of each point that they are to be over.
  Cells surface(const std::vector<std::uint64_t>& order) const;

 private:
  std::vector<GridPoint> orderedPoints(const GridFit& fit,
                                       const std::vector<std::uint64_t>& order) const;
  MeshCells renumbered(const std::vector<std::uint64_t>& order) const;
  void encodeArrays(const std::vector<GridPoint>& centres,
                    const std::vector<std::uint64_t>& cellOrder, unsigned effort,
                    container::MeshBlock& block, EncodeReport& report) const;

  const PointSetView& points_;
  const EncodeOptions& options_;
  const MeshCells* mesh_;
};

/// Where cells lie: the mean of their points, rounded down, relative to the corner of all points'
/// box. Cells in the order vertices, lines, faces; cells without points lie at the corner.
std::vector<GridPoint> cellCentres(const std::vector<GridPoint>& points, const MeshCells& cells);

/// Lengths of the grid's steps, for measuring distances.
std::array<double, 3> stepsOf(const Grid& grid);

}  // namespace bspc
