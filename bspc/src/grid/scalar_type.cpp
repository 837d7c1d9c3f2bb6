#include "bspc/scalar_type.h"

namespace bspc {

std::size_t scalarSize(ScalarType type) {
  switch (type) {
    case ScalarType::Int8:
    case ScalarType::UInt8:
      return 1;
    case ScalarType::Int16:
    case ScalarType::UInt16:
      return 2;
    case ScalarType::Float32:
    case ScalarType::Int32:
    case ScalarType::UInt32:
      return 4;
    case ScalarType::Float64:
    case ScalarType::Int64:
    case ScalarType::UInt64:
      return 8;
    case ScalarType::Bit:
    case ScalarType::String:
      break;
  }
  return 0;
}

const char* scalarName(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
      return "float32";
    case ScalarType::Float64:
      return "float64";
    case ScalarType::Int8:
      return "int8";
    case ScalarType::UInt8:
      return "uint8";
    case ScalarType::Int16:
      return "int16";
    case ScalarType::UInt16:
      return "uint16";
    case ScalarType::Int32:
      return "int32";
    case ScalarType::UInt32:
      return "uint32";
    case ScalarType::Int64:
      return "int64";
    case ScalarType::UInt64:
      return "uint64";
    case ScalarType::Bit:
      return "bit";
    case ScalarType::String:
      return "string";
  }
  return "unknown";
}

}  // namespace bspc
