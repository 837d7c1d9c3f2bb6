#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "bspc/scalar_type.h"

namespace bspc::attributes {

/// A float32 or float64 in memory.
inline double readFloat(const std::uint8_t* bytes, ScalarType type) {
  if (type == ScalarType::Float32) {
    float number = 0;
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
  }
  double number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

inline void writeFloat(double number, ScalarType type, std::uint8_t* bytes) {
  if (type == ScalarType::Float32) {
    const auto rounded = static_cast<float>(number);
    std::memcpy(bytes, &rounded, sizeof rounded);
  } else {
    std::memcpy(bytes, &number, sizeof number);
  }
}

/// The unsigned integer of so many bytes.
constexpr ScalarType unsignedType(std::size_t size) {
  switch (size) {
    case 1:
      return ScalarType::UInt8;
    case 2:
      return ScalarType::UInt16;
    case 4:
      return ScalarType::UInt32;
    default:
      return ScalarType::UInt64;
  }
}

}  // namespace bspc::attributes
