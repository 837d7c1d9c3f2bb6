#include "vtk_support/field_data.h"

#include <vtkNew.h>
#include <vtkStringArray.h>

#include "bspc/error.h"
#include "vtk_support/array_input.h"
#include "vtk_support/array_output.h"

namespace bspc::vtk {

namespace {

void addText(vtkFieldData* fieldData, const std::string& name, const std::string& text) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(text);
  fieldData->AddArray(array);
}

/// The text of an array that is nothing but one string, else null.
const std::string* onlyText(vtkAbstractArray* array) {
  auto* strings = vtkStringArray::SafeDownCast(array);
  if (strings == nullptr || strings->GetNumberOfValues() != 1) return nullptr;
  return strings->HasAComponentName() ? nullptr : &strings->GetValue(0);
}

void addArray(Metadata& metadata, vtkAbstractArray* array) {
  const char* name = array->GetName();
  if (name == nullptr || *name == '\0') {
    throw Error(ErrorCode::InvalidArgument,
                "an array of the field data has no name; name it or remove it");
  }
  const std::string* text = onlyText(array);
  if (text == nullptr) {
    metadata.fieldData.push_back(arrayValues(array, name));
  } else if (std::string(name) == kCrsArray) {
    metadata.crs = *text;
  } else if (std::string(name) == kLengthUnitArray) {
    metadata.lengthUnit = *text;
  } else {
    metadata.entries.emplace_back(name, *text);
  }
}

}  // namespace

Metadata metadataOf(vtkFieldData* fieldData) {
  Metadata metadata;
  if (fieldData == nullptr) return metadata;
  for (int i = 0; i < fieldData->GetNumberOfArrays(); ++i) {
    addArray(metadata, fieldData->GetAbstractArray(i));
  }
  return metadata;
}

void addMetadata(const Metadata& metadata, vtkFieldData* fieldData) {
  if (!metadata.crs.empty()) addText(fieldData, kCrsArray, metadata.crs);
  if (!metadata.lengthUnit.empty()) addText(fieldData, kLengthUnitArray, metadata.lengthUnit);
  for (const auto& [key, text] : metadata.entries) addText(fieldData, key, text);
  for (const ArrayValues& values : metadata.fieldData) {
    const vtkSmartPointer<vtkAbstractArray> array = newArray(values);
    appendValues(array, values);
    fieldData->AddArray(array);
  }
}

}  // namespace bspc::vtk
