#pragma once

#include <cstdint>

namespace bspc::geometry::fast {

// Byte by byte, so that the result is the same on every machine; compilers make one load or store
// of it where the machine allows.

inline std::uint32_t loadLittle16(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0]) | (static_cast<std::uint32_t>(p[1]) << 8);
}

inline std::uint32_t loadLittle32(const std::uint8_t* p) {
  return loadLittle16(p) | (loadLittle16(p + 2) << 16);
}

inline std::uint64_t loadLittle64(const std::uint8_t* p) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < 8; ++i) value |= std::uint64_t{p[i]} << (8 * i);
  return value;
}

inline void storeLittle16(std::uint8_t* p, std::uint32_t value) {
  p[0] = static_cast<std::uint8_t>(value);
  p[1] = static_cast<std::uint8_t>(value >> 8);
}

inline void storeLittle64(std::uint8_t* p, std::uint64_t value) {
  for (unsigned i = 0; i < 8; ++i) p[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace bspc::geometry::fast
