#include "vtkBSPReader/poly_data_builder.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "bspc/error.h"
#include "vtk_support/array_output.h"
#include "vtk_support/field_data.h"
#include "vtk_support/mesh_cells.h"

namespace bspc::vtk {

namespace {

vtkSmartPointer<vtkAbstractArray> newIds(const char* name) {
  auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->SetName(name);
  return ids;
}

void appendIds(vtkAbstractArray* array, const std::vector<std::uint64_t>& ids) {
  auto* to = static_cast<vtkIdTypeArray*>(array);
  vtkIdType* place = to->WritePointer(to->GetNumberOfValues(), static_cast<vtkIdType>(ids.size()));
  std::transform(ids.begin(), ids.end(), place,
                 [](std::uint64_t id) { return static_cast<vtkIdType>(id); });
}

/// Offsets or point ids of cells of one point each: 0, 1, 2, …
template <class Array>
vtkSmartPointer<Array> counting(vtkIdType count) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfValues(count);
  std::iota(array->GetPointer(0), array->GetPointer(0) + count, typename Array::ValueType{0});
  return array;
}

vtkSmartPointer<vtkCellArray> oneVertexEach(vtkIdType points) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  // Half the memory where ids are small enough.
  if (points < std::numeric_limits<std::int32_t>::max()) {
    cells->SetData(counting<vtkTypeInt32Array>(points + 1), counting<vtkTypeInt32Array>(points));
  } else {
    cells->SetData(counting<vtkTypeInt64Array>(points + 1), counting<vtkTypeInt64Array>(points));
  }
  return cells;
}

void activate(vtkDataSetAttributes* data, vtkAbstractArray* array, Semantic semantic) {
  const char* name = array->GetName();
  switch (semantic) {
    case Semantic::Scalars:
    case Semantic::Colours:
      data->SetActiveScalars(name);
      return;
    case Semantic::Normals:
      data->SetActiveNormals(name);
      return;
    case Semantic::TextureCoordinates:
      data->SetActiveTCoords(name);
      return;
    case Semantic::Ids:
      if (vtkIdTypeArray::SafeDownCast(array) != nullptr) {
        data->SetActiveGlobalIds(name);
      } else {
        data->SetActivePedigreeIds(name);
      }
      return;
    case Semantic::None:
      return;
  }
}

/// The cells with their arrays.
void setMesh(const DecodedPoints& mesh, vtkPolyData* output) {
  setCells(mesh.mesh, output);
  for (const ArrayValues& values : mesh.cellArrays) {
    const vtkSmartPointer<vtkAbstractArray> array = newArray(values);
    appendValues(array, values);
    output->GetCellData()->AddArray(array);
    activate(output->GetCellData(), array, values.semantic);
  }
}

std::uint64_t bytesPerVertex(bool vertices) { return vertices ? 2 * sizeof(std::int32_t) : 0; }

}  // namespace

int coordinateType(const FileInfo& info) {
  if (info.grid.scalarType == ScalarType::Float32) return VTK_FLOAT;
  if (info.grid.scalarType == ScalarType::Float64) return VTK_DOUBLE;
  // Whole numbers up to 2^24 are floats too.
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    for (const std::uint32_t i : {info.lower[k], info.upper[k]}) {
      if (std::abs(restoredCoordinate(info.grid, axis, i)) > 1 << 24) return VTK_DOUBLE;
    }
  }
  return VTK_FLOAT;
}

PolyDataBuilder::PolyDataBuilder(const FileInfo& info, Options options)
    : info_(info), options_(std::move(options)) {
  coordinates_.TakeReference(vtkDataArray::CreateDataArray(coordinateType(info)));
  coordinates_->SetNumberOfComponents(3);
  if (options_.cellIds) cellIds_ = newIds("CellId");
  if (options_.counts) counts_ = newIds("PointCount");
  for (const ArrayInfo& array : options_.arrays) {
    for (const auto& made : {cellIds_, counts_}) {
      if (made != nullptr && array.name == made->GetName()) {
        throw Error(ErrorCode::InvalidArgument,
                    "the file has an array of its own that is called \"" + array.name +
                        "\"; switch that or the array that is made off");
      }
    }
    arrays_.push_back(newArray(array));
  }
}

void PolyDataBuilder::checkMemory(const DecodedPoints& tile) {
  const std::uint64_t ids = (options_.cellIds ? 1 : 0) + (options_.counts ? 1 : 0);
  const std::uint64_t perPoint = 3 * static_cast<std::uint64_t>(coordinates_->GetDataTypeSize()) +
                                 bytesPerVertex(options_.vertices) + ids * sizeof(vtkIdType);
  bytes_ += tile.points.size() * perPoint;
  for (const ArrayValues& values : tile.arrays) {
    bytes_ += values.values.size() + values.strings.size() * sizeof(std::string);
    for (const std::string& text : values.strings) bytes_ += text.size();
  }
  if (bytes_ > options_.memoryBytes) {
    throw Error(ErrorCode::LimitExceeded,
                "the points and arrays take more than the limit of " +
                    std::to_string(options_.memoryBytes >> 20) +
                    " MiB; read a coarser level, a box or fewer arrays, or raise the limit");
  }
}

void PolyDataBuilder::appendCoordinates(const DecodedPoints& tile) {
  void* place = coordinates_->WriteVoidPointer(coordinates_->GetNumberOfValues(),
                                               3 * static_cast<vtkIdType>(tile.points.size()));
  if (coordinates_->GetDataType() == VTK_FLOAT) {
    restorePositions(info_.grid, tile, static_cast<float*>(place));
  } else {
    restorePositions(info_.grid, tile, static_cast<double*>(place));
  }
}

void PolyDataBuilder::append(const DecodedPoints& tile) {
  checkMemory(tile);
  appendCoordinates(tile);
  for (std::size_t i = 0; i < arrays_.size(); ++i) appendValues(arrays_[i], tile.arrays.at(i));
  if (cellIds_ != nullptr) appendIds(cellIds_, tile.cellIds);
  if (counts_ != nullptr) appendIds(counts_, tile.counts);
}

void PolyDataBuilder::finish(vtkPolyData* output, const DecodedPoints* mesh) {
  vtkNew<vtkPoints> points;
  points->SetData(coordinates_);
  points->Squeeze();
  output->SetPoints(points);
  vtkPointData* data = output->GetPointData();
  for (const auto& array : arrays_) {
    array->Squeeze();
    data->AddArray(array);
  }
  // Colours are shown unless the file names scalars: those come last.
  for (const bool scalars : {false, true}) {
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      const Semantic semantic = options_.arrays[i].semantic;
      if ((semantic == Semantic::Scalars) == scalars) activate(data, arrays_[i], semantic);
    }
  }
  for (const auto& made : {cellIds_, counts_}) {
    if (made == nullptr) continue;
    made->Squeeze();
    data->AddArray(made);
  }
  if (mesh != nullptr && !mesh->mesh.empty()) {
    setMesh(*mesh, output);
  } else if (options_.vertices) {
    output->SetVerts(oneVertexEach(output->GetNumberOfPoints()));
  }
  addMetadata(info_.metadata, output->GetFieldData());
}

}  // namespace bspc::vtk
