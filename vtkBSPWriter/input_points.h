#pragma once

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bspc/point_set.h"
#include "vtk_support/array_input.h"

namespace bspc::vtk {

/// The points and arrays of a VTK data object as the library takes them; shares its memory where
/// that is possible, and keeps it alive.
class InputPoints {
 public:
  struct Options {
    bool dropCells = false;
    std::function<bool(const char*)> wantsArray;
    std::map<std::string, double> tolerances;
  };

  /// Cells of poly data are taken, unless they are nothing but vertices without arrays, which need
  /// not be stored. Throws Error: Unsupported for cells and arrays that cannot be stored;
  /// InvalidArgument for a table without x, y and z, and for arrays without a name or of another
  /// length than the points.
  InputPoints(vtkDataObject* input, const Options& options);

  PointSetView view() const;

 private:
  void takePoints(vtkPointSet* points);
  void takeColumns(vtkTable* table);
  void takeCells(vtkPolyData* mesh);
  void setCoordinates(vtkDataArray* coordinates);
  void takePointArrays(const Options& options);
  void leaveOutGhosts();

  vtkSmartPointer<vtkDataArray> coordinates_;
  vtkSmartPointer<vtkDataSetAttributes> attributes_;
  std::vector<ArrayInput> arrays_;
  std::map<std::string, double> tolerances_;
  MeshCells cells_;
  std::vector<ArrayInput> cellArrays_;
};

}  // namespace bspc::vtk
