#include "formats/scalar_common.h"

#include <algorithm>

namespace bspc::formats {

namespace {

/// Binary digits that every number of the type has exactly, its sign left out.
unsigned exactDigits(ScalarType type) {
  if (type == ScalarType::Float32) return 24;
  if (type == ScalarType::Float64) return 53;
  const bool isSigned = type == ScalarType::Int8 || type == ScalarType::Int16 ||
                        type == ScalarType::Int32 || type == ScalarType::Int64;
  return static_cast<unsigned>(8 * scalarSize(type)) - (isSigned ? 1U : 0U);
}

bool isUnsigned(ScalarType type) { return !isFloatingPoint(type) && exactDigits(type) % 8 == 0; }

bool holds(ScalarType type, ScalarType other) {
  if (isFloatingPoint(other) && !isFloatingPoint(type)) return false;
  if (isUnsigned(type) && !isUnsigned(other)) return false;
  return exactDigits(type) >= exactDigits(other);
}

}  // namespace

ScalarType commonScalarType(const std::array<ScalarType, 3>& types) {
  constexpr std::array<ScalarType, 9> kBySize{
      ScalarType::Int8,    ScalarType::UInt8, ScalarType::Int16,
      ScalarType::UInt16,  ScalarType::Int32, ScalarType::UInt32,
      ScalarType::Float32, ScalarType::Int64, ScalarType::UInt64};
  for (const ScalarType type : kBySize) {
    if (std::all_of(types.begin(), types.end(), [&](ScalarType t) { return holds(type, t); })) {
      return type;
    }
  }
  return ScalarType::Float64;
}

}  // namespace bspc::formats
