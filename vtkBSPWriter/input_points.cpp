#include "vtkBSPWriter/input_points.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <vtksys/SystemTools.hxx>

#include "bspc/error.h"
#include "vtk_support/array_types.h"
#include "vtk_support/mesh_cells.h"

namespace bspc::vtk {

namespace {

/// Whether a mesh has nothing but vertices, which the reader makes by itself, and says nothing of
/// them.
bool hasImpliedCells(vtkPolyData* mesh) {
  const vtkIdType others = mesh->GetNumberOfCells() - mesh->GetNumberOfVerts();
  vtkCellData* data = mesh->GetCellData();
  const bool ghosts = data->HasArray(vtkDataSetAttributes::GhostArrayName()) != 0;
  return others == 0 && data->GetNumberOfArrays() == (ghosts ? 1 : 0);
}

bool hasGhosts(vtkDataSetAttributes* attributes) {
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
      attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return ghosts != nullptr && ghosts->GetValueRange(0)[1] != 0;
}

void refuseCells(vtkPointSet* points) {
  vtkNew<vtkCellTypes> types;
  points->GetCellTypes(types);
  for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i) {
    const int type = types->GetCellType(i);
    if (type == VTK_EMPTY_CELL || type == VTK_VERTEX || type == VTK_POLY_VERTEX) continue;
    throw Error(ErrorCode::Unsupported,
                std::string("the input has cells of type ") +
                    vtkCellTypes::GetClassNameFromTypeId(type) +
                    ", and only those of poly data can be stored; vtkDataSetSurfaceFilter makes "
                    "such of the surface, DropCells leaves cells out");
  }
  for (int i = 0; i < points->GetCellData()->GetNumberOfArrays(); ++i) {
    const char* name = points->GetCellData()->GetAbstractArray(i)->GetName();
    if (name != nullptr && std::string(name) == vtkDataSetAttributes::GhostArrayName()) continue;
    throw Error(ErrorCode::Unsupported,
                "the input has the cell array \"" + std::string(name != nullptr ? name : "") +
                    "\", and only cells of poly data can have some; DropCells leaves them out");
  }
}

/// The column of that name, in capitals or not; null if there is none.
vtkDataArray* columnOf(vtkTable* table, const char* name) {
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i) {
    const char* column = table->GetColumnName(i);
    if (column == nullptr || vtksys::SystemTools::LowerCase(column) != name) continue;
    if (auto* numbers = vtkDataArray::SafeDownCast(table->GetColumn(i))) return numbers;
  }
  return nullptr;
}

/// What an active attribute means to the library.
Semantic semanticOf(vtkDataSetAttributes* attributes, vtkAbstractArray* array) {
  if (array == attributes->GetNormals()) return Semantic::Normals;
  if (array == attributes->GetTCoords()) return Semantic::TextureCoordinates;
  if (array == attributes->GetScalars()) {
    const int components = array->GetNumberOfComponents();
    const bool colours =
        array->GetDataType() == VTK_UNSIGNED_CHAR && (components == 3 || components == 4);
    return colours ? Semantic::Colours : Semantic::Scalars;
  }
  // Only ids of VTK's own type are read as global ids again, and others as pedigree ids.
  const bool ownType = array->GetDataType() == VTK_ID_TYPE;
  if (array == attributes->GetGlobalIds() && ownType) return Semantic::Ids;
  const bool asInt64 = scalarTypeOfVtk(array->GetDataType()) == ScalarType::Int64;
  if (array == attributes->GetPedigreeIds() && !asInt64) return Semantic::Ids;
  return Semantic::None;
}

/// The name of an array; one without is called after what it is active as.
std::string nameOf(vtkAbstractArray* array, Semantic semantic) {
  if (array->GetName() != nullptr && *array->GetName() != '\0') return array->GetName();
  switch (semantic) {
    case Semantic::Normals:
      return "Normals";
    case Semantic::TextureCoordinates:
      return "TCoords";
    case Semantic::Scalars:
    case Semantic::Colours:
      return "Scalars";
    case Semantic::Ids:
      return "Ids";
    case Semantic::None:
      break;
  }
  throw Error(ErrorCode::InvalidArgument, "an array has no name; name it or remove it");
}

}  // namespace

InputPoints::InputPoints(vtkDataObject* input, const Options& options) {
  if (auto* table = vtkTable::SafeDownCast(input)) {
    takeColumns(table);
  } else if (auto* points = vtkPointSet::SafeDownCast(input)) {
    takePoints(points);
    auto* mesh = vtkPolyData::SafeDownCast(points);
    if (mesh != nullptr && !options.dropCells && !hasImpliedCells(mesh)) {
      takeCells(mesh);
    } else if (mesh == nullptr && !options.dropCells) {
      refuseCells(points);
    }
  } else {
    throw Error(ErrorCode::InvalidArgument, "the input is neither a point set nor a table");
  }
  leaveOutGhosts();
  takePointArrays(options);
}

void InputPoints::takeCells(vtkPolyData* mesh) {
  if (hasGhosts(mesh->GetPointData()) || hasGhosts(mesh->GetCellData())) {
    throw Error(ErrorCode::Unsupported,
                "the input has cells with ghosts; vtkRemoveGhosts takes ghosts away, DropCells "
                "leaves cells out");
  }
  cells_ = meshCellsOf(mesh);
  vtkCellData* data = mesh->GetCellData();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    const Semantic semantic = semanticOf(data, array);
    const std::string name = nameOf(array, semantic);
    if (name == vtkDataSetAttributes::GhostArrayName()) continue;
    cellArrays_.emplace_back(array, name, semantic);
  }
}

void InputPoints::takePoints(vtkPointSet* points) {
  attributes_ = points->GetPointData();
  if (points->GetPoints() != nullptr) {
    setCoordinates(points->GetPoints()->GetData());
  } else {
    coordinates_.TakeReference(vtkDataArray::CreateDataArray(VTK_FLOAT));
    coordinates_->SetNumberOfComponents(3);
  }
}

void InputPoints::takeColumns(vtkTable* table) {
  std::array<vtkDataArray*, 3> columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const char* name = k == 0 ? "x" : k == 1 ? "y" : "z";
    columns[k] = columnOf(table, name);
    if (columns[k] == nullptr || columns[k]->GetNumberOfComponents() != 1) {
      throw Error(ErrorCode::InvalidArgument,
                  std::string("the table has no column of numbers that is called ") + name);
    }
  }
  // One type for all three: the common one, else the one that holds any of them.
  const bool same = columns[0]->GetDataType() == columns[1]->GetDataType() &&
                    columns[0]->GetDataType() == columns[2]->GetDataType();
  auto xyz = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(same ? columns[0]->GetDataType() : VTK_DOUBLE));
  xyz->SetNumberOfComponents(3);
  xyz->SetNumberOfTuples(table->GetNumberOfRows());
  attributes_ = vtkSmartPointer<vtkDataSetAttributes>::New();
  attributes_->ShallowCopy(table->GetRowData());
  for (int k = 0; k < 3; ++k) {
    vtkDataArray* column = columns[static_cast<std::size_t>(k)];
    xyz->CopyComponent(k, column, 0);
    attributes_->RemoveArray(column->GetName());
  }
  setCoordinates(xyz);
}

/// Takes positions of a type that the library knows, their values side by side.
void InputPoints::setCoordinates(vtkDataArray* coordinates) {
  const std::optional<ScalarType> type = scalarTypeOfVtk(coordinates->GetDataType());
  const bool stored = type && static_cast<std::uint8_t>(*type) < kPositionTypeCount;
  coordinates_ = coordinates;
  if (stored && coordinates->HasStandardMemoryLayout()) return;
  coordinates_.TakeReference(
      vtkDataArray::CreateDataArray(stored ? coordinates->GetDataType() : VTK_DOUBLE));
  coordinates_->DeepCopy(coordinates);
}

/// Takes copies without the points that belong to another piece or are blanked.
void InputPoints::leaveOutGhosts() {
  const char* ghostName = vtkDataSetAttributes::GhostArrayName();
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(attributes_->GetAbstractArray(ghostName));
  if (ghosts == nullptr) return;
  const unsigned mask = vtkDataSetAttributes::DUPLICATEPOINT | vtkDataSetAttributes::HIDDENPOINT;
  vtkNew<vtkIdList> kept;
  for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i) {
    if ((ghosts->GetValue(i) & mask) == 0) kept->InsertNextId(i);
  }
  auto attributes = vtkSmartPointer<vtkDataSetAttributes>::New();
  if (kept->GetNumberOfIds() == coordinates_->GetNumberOfTuples()) {
    attributes->ShallowCopy(attributes_);
  } else {
    vtkNew<vtkIdList> places;
    for (vtkIdType i = 0; i < kept->GetNumberOfIds(); ++i) places->InsertNextId(i);
    attributes->CopyAllOn();
    attributes->CopyAllocate(attributes_, kept->GetNumberOfIds());
    attributes->CopyData(attributes_, kept, places);
    auto coordinates = vtkSmartPointer<vtkDataArray>::Take(
        vtkDataArray::CreateDataArray(coordinates_->GetDataType()));
    coordinates->SetNumberOfComponents(3);
    coordinates->InsertTuples(places, kept, coordinates_);
    coordinates_ = coordinates;
  }
  attributes->RemoveArray(ghostName);
  attributes_ = attributes;
}

void InputPoints::takePointArrays(const Options& options) {
  tolerances_ = options.tolerances;
  for (int i = 0; i < attributes_->GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = attributes_->GetAbstractArray(i);
    const char* name = array->GetName();
    if (name != nullptr && options.wantsArray && !options.wantsArray(name)) continue;
    const Semantic semantic = semanticOf(attributes_, array);
    arrays_.emplace_back(array, nameOf(array, semantic), semantic);
  }
}

PointSetView InputPoints::view() const {
  PointSetView points(coordinates_->GetVoidPointer(0),
                      *scalarTypeOfVtk(coordinates_->GetDataType()),
                      static_cast<std::uint64_t>(coordinates_->GetNumberOfTuples()), 0);
  for (const ArrayInput& array : arrays_) {
    ArrayView view = array.view();
    const auto tolerance = tolerances_.find(view.name);
    if (tolerance != tolerances_.end()) view.tolerance = tolerance->second;
    points.addArray(std::move(view));
  }
  if (!cells_.empty()) points.setMesh(&cells_);
  for (const ArrayInput& array : cellArrays_) points.addCellArray(array.view());
  return points;
}

}  // namespace bspc::vtk
