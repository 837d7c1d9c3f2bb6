#include "vtk_support/array_output.h"

#include <vtkBitArray.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkStringArray.h>

#include <cstring>

#include "vtk_support/array_types.h"

namespace bspc::vtk {

vtkSmartPointer<vtkAbstractArray> newArray(const ArrayDescription& description) {
  // Ids are what VTK calls global ids if they are of its own type for them.
  const bool ids = description.semantic == Semantic::Ids && description.type == ScalarType::Int64 &&
                   sizeof(vtkIdType) == sizeof(std::int64_t);
  auto array = vtkSmartPointer<vtkAbstractArray>::Take(
      vtkAbstractArray::CreateArray(ids ? VTK_ID_TYPE : vtkTypeOf(description.type)));
  array->SetName(description.name.c_str());
  array->SetNumberOfComponents(static_cast<int>(description.components));
  for (std::size_t i = 0; i < description.componentNames.size(); ++i) {
    if (description.componentNames[i].empty()) continue;
    array->SetComponentName(static_cast<vtkIdType>(i), description.componentNames[i].c_str());
  }
  if (!description.unit.empty()) {
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), description.unit.c_str());
  }
  return array;
}

void appendValues(vtkAbstractArray* array, const ArrayValues& values) {
  if (auto* strings = vtkStringArray::SafeDownCast(array)) {
    for (const std::string& value : values.strings) strings->InsertNextValue(value);
  } else if (auto* bits = vtkBitArray::SafeDownCast(array)) {
    for (const std::uint8_t value : values.values) bits->InsertNextValue(value);
  } else if (!values.values.empty()) {
    const std::size_t count = values.values.size() / arrayValueSize(values.type);
    auto* numbers = static_cast<vtkDataArray*>(array);
    void* place =
        numbers->WriteVoidPointer(numbers->GetNumberOfValues(), static_cast<vtkIdType>(count));
    std::memcpy(place, values.values.data(), values.values.size());
  }
}

}  // namespace bspc::vtk
