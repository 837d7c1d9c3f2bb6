#pragma once

#include <optional>

#include "bspc/scalar_type.h"

namespace bspc::vtk {

/// What an array of that VTK type is stored as; empty if it cannot be stored.
std::optional<ScalarType> scalarTypeOfVtk(int vtkType);

/// The VTK type that values of that type come back as.
int vtkTypeOf(ScalarType type);

}  // namespace bspc::vtk
