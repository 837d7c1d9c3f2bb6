#include "vtk_support/mesh_cells.h"

#include <vtkCellArray.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <cstdint>

#include "bspc/error.h"

namespace bspc::vtk {

namespace {

constexpr vtkIdType kMostNumbers = vtkIdType{0xFFFFFFF0};

Cells cellsOf(vtkCellArray* array) {
  Cells cells;
  if (array->GetNumberOfConnectivityIds() > kMostNumbers) {
    throw Error(ErrorCode::Unsupported,
                "the cells list more points than can be numbered; DropCells leaves cells out");
  }
  cells.ends.reserve(static_cast<std::size_t>(array->GetNumberOfCells()));
  cells.indices.reserve(static_cast<std::size_t>(array->GetNumberOfConnectivityIds()));
  for (vtkIdType i = 0; i < array->GetNumberOfCells(); ++i) {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    array->GetCellAtId(i, count, points);
    for (vtkIdType k = 0; k < count; ++k) {
      cells.indices.push_back(static_cast<std::uint32_t>(points[k]));
    }
    cells.ends.push_back(static_cast<std::uint32_t>(cells.indices.size()));
  }
  return cells;
}

vtkSmartPointer<vtkCellArray> cellArrayOf(const Cells& cells) {
  auto offsets = vtkSmartPointer<vtkTypeInt64Array>::New();
  offsets->SetNumberOfValues(static_cast<vtkIdType>(cells.size()) + 1);
  offsets->SetValue(0, 0);
  std::copy(cells.ends.begin(), cells.ends.end(), offsets->GetPointer(1));
  auto points = vtkSmartPointer<vtkTypeInt64Array>::New();
  points->SetNumberOfValues(static_cast<vtkIdType>(cells.indices.size()));
  std::copy(cells.indices.begin(), cells.indices.end(), points->GetPointer(0));
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, points);
  return array;
}

}  // namespace

MeshCells meshCellsOf(vtkPolyData* data) {
  if (data->GetNumberOfStrips() > 0) {
    throw Error(ErrorCode::Unsupported,
                "the input has triangle strips, which cannot be stored; vtkTriangleFilter makes "
                "triangles of them, and DropCells leaves cells out");
  }
  if (data->GetNumberOfPoints() > kMostNumbers) {
    throw Error(ErrorCode::Unsupported,
                "the input has more points than cells can number; DropCells leaves cells out");
  }
  MeshCells cells;
  cells.vertices = cellsOf(data->GetVerts());
  cells.lines = cellsOf(data->GetLines());
  cells.faces = cellsOf(data->GetPolys());
  return cells;
}

void setCells(const MeshCells& cells, vtkPolyData* data) {
  if (!cells.vertices.empty()) data->SetVerts(cellArrayOf(cells.vertices));
  if (!cells.lines.empty()) data->SetLines(cellArrayOf(cells.lines));
  if (!cells.faces.empty()) data->SetPolys(cellArrayOf(cells.faces));
}

}  // namespace bspc::vtk
