#pragma once

#include <vtkPolyData.h>

#include "bspc/mesh.h"

namespace bspc::vtk {

/// The vertices, lines and polygons of poly data, in the order of its cell data. Throws
/// Error(Unsupported) for triangle strips, and for more points or cells than can be numbered.
MeshCells meshCellsOf(vtkPolyData* data);

/// Gives poly data without cells those of a mesh.
void setCells(const MeshCells& cells, vtkPolyData* data);

}  // namespace bspc::vtk
