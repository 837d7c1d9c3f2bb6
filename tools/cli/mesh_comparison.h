#pragma once

#include <string>
#include <vector>

#include "bspc/grid.h"
#include "bspc/mesh.h"

namespace bspc::cli {

/// Cells and where their points are.
struct PlacedMesh {
  const MeshCells& mesh;
  const std::vector<GridPoint>& points;
};

/// Whether both have the same cells, by the places of their points: faces from any point on but in
/// the same sense, vertex cells with their points in any order; all cells in any order.
bool sameCells(const PlacedMesh& a, const PlacedMesh& b);

/// "12 faces", "3 lines, 12 faces".
std::string cellsText(std::uint64_t vertices, std::uint64_t lines, std::uint64_t faces);

}  // namespace bspc::cli
