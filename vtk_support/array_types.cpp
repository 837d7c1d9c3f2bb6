#include "vtk_support/array_types.h"

#include <vtkType.h>

#include <type_traits>

namespace bspc::vtk {

std::optional<ScalarType> scalarTypeOfVtk(int vtkType) {
  switch (vtkType) {
    case VTK_FLOAT:
      return ScalarType::Float32;
    case VTK_DOUBLE:
      return ScalarType::Float64;
    case VTK_CHAR:
      return std::is_signed_v<char> ? ScalarType::Int8 : ScalarType::UInt8;
    case VTK_SIGNED_CHAR:
      return ScalarType::Int8;
    case VTK_UNSIGNED_CHAR:
      return ScalarType::UInt8;
    case VTK_SHORT:
      return ScalarType::Int16;
    case VTK_UNSIGNED_SHORT:
      return ScalarType::UInt16;
    case VTK_INT:
      return ScalarType::Int32;
    case VTK_UNSIGNED_INT:
      return ScalarType::UInt32;
    case VTK_LONG:
      return sizeof(long) == 8 ? ScalarType::Int64 : ScalarType::Int32;
    case VTK_UNSIGNED_LONG:
      return sizeof(long) == 8 ? ScalarType::UInt64 : ScalarType::UInt32;
    case VTK_LONG_LONG:
      return ScalarType::Int64;
    case VTK_UNSIGNED_LONG_LONG:
      return ScalarType::UInt64;
    case VTK_ID_TYPE:
      return sizeof(vtkIdType) == 8 ? ScalarType::Int64 : ScalarType::Int32;
    case VTK_BIT:
      return ScalarType::Bit;
    case VTK_STRING:
      return ScalarType::String;
    default:
      return std::nullopt;
  }
}

int vtkTypeOf(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
      return VTK_TYPE_FLOAT32;
    case ScalarType::Float64:
      return VTK_TYPE_FLOAT64;
    case ScalarType::Int8:
      return VTK_TYPE_INT8;
    case ScalarType::UInt8:
      return VTK_TYPE_UINT8;
    case ScalarType::Int16:
      return VTK_TYPE_INT16;
    case ScalarType::UInt16:
      return VTK_TYPE_UINT16;
    case ScalarType::Int32:
      return VTK_TYPE_INT32;
    case ScalarType::UInt32:
      return VTK_TYPE_UINT32;
    case ScalarType::Int64:
      return VTK_TYPE_INT64;
    case ScalarType::UInt64:
      return VTK_TYPE_UINT64;
    case ScalarType::Bit:
      return VTK_BIT;
    case ScalarType::String:
      return VTK_STRING;
  }
  return VTK_VOID;
}

}  // namespace bspc::vtk
