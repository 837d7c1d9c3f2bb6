#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "formats/scalar_convert.h"
#include "formats/scalar_visit.h"

namespace bspc::formats {

/// The little-endian number of type `type`, whose C++ type is T, at an address of any alignment.
template <class T>
T loadLittleEndian(const void* from, ScalarType type) {
  T value{};
  convertScalars({from, type, 0, !hostIsLittleEndian()}, {&value, type, 0}, 1);
  return value;
}

/// Stores a number at an address of any alignment, least byte first.
template <class T>
void storeLittleEndian(void* to, T value) {
  std::memcpy(to, &value, sizeof(T));
  auto* const bytes = static_cast<unsigned char*>(to);
  if (!hostIsLittleEndian()) std::reverse(bytes, bytes + sizeof(T));
}

inline std::uint16_t loadUInt16(const void* from) {
  return loadLittleEndian<std::uint16_t>(from, ScalarType::UInt16);
}
inline std::uint32_t loadUInt32(const void* from) {
  return loadLittleEndian<std::uint32_t>(from, ScalarType::UInt32);
}
inline std::uint64_t loadUInt64(const void* from) {
  return loadLittleEndian<std::uint64_t>(from, ScalarType::UInt64);
}
inline double loadFloat64(const void* from) {
  return loadLittleEndian<double>(from, ScalarType::Float64);
}

}  // namespace bspc::formats
