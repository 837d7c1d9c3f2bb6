#pragma once

#include <vtkAbstractArray.h>
#include <vtkSmartPointer.h>

#include <string>

#include "bspc/arrays.h"

namespace bspc::vtk {

/// A VTK array as the library wants to see it: packed values, with what VTK knows about them.
/// Shares memory with the VTK array where its layout allows, and keeps it alive.
class ArrayInput {
 public:
  /// Throws Error(Unsupported) that names the array if values of its type cannot be stored.
  ArrayInput(vtkAbstractArray* array, const std::string& name, Semantic semantic);

  ArrayInput(ArrayInput&&) noexcept = default;
  ArrayInput& operator=(ArrayInput&&) noexcept = default;

  /// Valid as long as this is, or what it is moved to.
  const ArrayView& view() const { return view_; }

 private:
  vtkSmartPointer<vtkAbstractArray> array_;
  Bytes bits_;  ///< values of a bit array, one a byte
  ArrayView view_;
};

/// A copy of a VTK array. Throws as ArrayInput does.
ArrayValues arrayValues(vtkAbstractArray* array, const std::string& name);

}  // namespace bspc::vtk
