#pragma once

#include "bspc/error.h"

namespace bspc::vtk {

/// The code of vtkErrorCode that a VTK reader or writer reports for an error of the library.
unsigned long vtkErrorCodeOf(ErrorCode code);

}  // namespace bspc::vtk
