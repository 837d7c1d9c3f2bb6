#pragma once

#include <cstdint>
#include <cstring>

#include "bspc/scalar_type.h"
#include "formats/model.h"

namespace bspc::formats {

/// Calls `visit` with a zero of the C++ type that holds numbers of `type`.
template <class Visit>
decltype(auto) visitScalar(ScalarType type, Visit&& visit) {
  switch (type) {
    case ScalarType::Float32:
      return visit(float{});
    case ScalarType::Float64:
      return visit(double{});
    case ScalarType::Int8:
      return visit(std::int8_t{});
    case ScalarType::UInt8:
      return visit(std::uint8_t{});
    case ScalarType::Int16:
      return visit(std::int16_t{});
    case ScalarType::UInt16:
      return visit(std::uint16_t{});
    case ScalarType::Int32:
      return visit(std::int32_t{});
    case ScalarType::UInt32:
      return visit(std::uint32_t{});
    case ScalarType::Int64:
      return visit(std::int64_t{});
    case ScalarType::UInt64:
      return visit(std::uint64_t{});
    case ScalarType::Bit:
    case ScalarType::String:
      break;
  }
  throw FormatError("positions cannot be bits or strings");
}

/// The number at an address of any alignment.
template <class T>
T loadScalar(const void* from) {
  T value{};
  std::memcpy(&value, from, sizeof(T));
  return value;
}

}  // namespace bspc::formats
