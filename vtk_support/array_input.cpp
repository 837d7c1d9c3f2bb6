#include "vtk_support/array_input.h"

#include <vtkBitArray.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkStringArray.h>

#include "bspc/error.h"
#include "vtk_support/array_types.h"

namespace bspc::vtk {

namespace {

// The elements of a vtkStringArray are seen as strings, which they derive from and add nothing to.
static_assert(sizeof(vtkStdString) == sizeof(std::string));

ScalarType storedType(vtkAbstractArray* array, const std::string& name) {
  const std::optional<ScalarType> type = scalarTypeOfVtk(array->GetDataType());
  if (!type) {
    throw Error(ErrorCode::Unsupported, "the array \"" + name + "\" has values of type " +
                                            array->GetDataTypeAsString() +
                                            ", which cannot be stored; leave the array out");
  }
  return *type;
}

std::vector<std::string> componentNames(vtkAbstractArray* array) {
  std::vector<std::string> names;
  if (!array->HasAComponentName()) return names;
  for (int i = 0; i < array->GetNumberOfComponents(); ++i) {
    const char* name = array->GetComponentName(i);
    names.emplace_back(name != nullptr ? name : "");
  }
  return names;
}

std::string unit(vtkAbstractArray* array) {
  if (!array->HasInformation()) return {};
  const char* label = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL());
  return label != nullptr ? label : "";
}

Bytes unpackedBits(vtkBitArray* array) {
  Bytes bits(static_cast<std::size_t>(array->GetNumberOfValues()));
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bits[i] = static_cast<std::uint8_t>(array->GetValue(static_cast<vtkIdType>(i)));
  }
  return bits;
}

/// The array itself, or a copy whose values lie side by side.
vtkSmartPointer<vtkAbstractArray> packed(vtkAbstractArray* array) {
  if (array->HasStandardMemoryLayout()) return array;
  auto copy =
      vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(array->GetDataType()));
  copy->DeepCopy(array);
  return copy;
}

}  // namespace

ArrayInput::ArrayInput(vtkAbstractArray* array, const std::string& name, Semantic semantic) {
  view_.name = name;
  view_.type = storedType(array, name);
  view_.components = static_cast<std::uint32_t>(array->GetNumberOfComponents());
  view_.componentNames = componentNames(array);
  view_.unit = unit(array);
  view_.semantic = semantic;
  view_.tuples = static_cast<std::uint64_t>(array->GetNumberOfTuples());
  if (auto* bits = vtkBitArray::SafeDownCast(array)) {
    bits_ = unpackedBits(bits);
    view_.data = bits_.data();
  } else if (auto* strings = vtkStringArray::SafeDownCast(array)) {
    array_ = strings;
    view_.data = static_cast<const std::string*>(strings->GetPointer(0));
  } else {
    array_ = packed(array);
    view_.data = array_->GetVoidPointer(0);
  }
}

ArrayValues arrayValues(vtkAbstractArray* array, const std::string& name) {
  const ArrayInput input(array, name, Semantic::None);
  const ArrayView& view = input.view();
  ArrayValues values;
  const ArrayDescription& description = view;
  static_cast<ArrayDescription&>(values) = description;
  const std::size_t count = static_cast<std::size_t>(view.tuples) * view.components;
  if (view.type == ScalarType::String) {
    const auto* first = static_cast<const std::string*>(view.data);
    values.strings.assign(first, first + count);
  } else {
    const auto* first = static_cast<const std::uint8_t*>(view.data);
    values.values.assign(first, first + count * arrayValueSize(view.type));
  }
  return values;
}

}  // namespace bspc::vtk
