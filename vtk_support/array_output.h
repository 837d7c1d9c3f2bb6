#pragma once

#include <vtkAbstractArray.h>
#include <vtkSmartPointer.h>

#include "bspc/arrays.h"

namespace bspc::vtk {

/// An empty VTK array for the values of that description.
vtkSmartPointer<vtkAbstractArray> newArray(const ArrayDescription& description);

/// Appends values to an array that newArray made for the same type and components.
void appendValues(vtkAbstractArray* array, const ArrayValues& values);

}  // namespace bspc::vtk
