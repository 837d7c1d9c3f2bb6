#pragma once

#include <vtkFieldData.h>

#include "bspc/arrays.h"

namespace bspc::vtk {

/// Names of the field data arrays that hold what Metadata has fields for.
constexpr const char* kCrsArray = "CRS";
constexpr const char* kLengthUnitArray = "LengthUnit";

/// What a data set says beside its points. An array of one string is a text entry, every other one
/// is an array. Throws Error(Unsupported) that names an array that cannot be stored.
Metadata metadataOf(vtkFieldData* fieldData);

/// Adds what the file says to the field data, so that metadataOf() finds the same there.
void addMetadata(const Metadata& metadata, vtkFieldData* fieldData);

}  // namespace bspc::vtk
