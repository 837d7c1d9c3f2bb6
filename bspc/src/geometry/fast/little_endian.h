#pragma once

#include <cstdint>
#include <cstring>

namespace bspc::geometry::fast {

/// Whether numbers stand in memory as they do in files.
#if defined(__BYTE_ORDER__) && defined(__ORDER_LITTLE_ENDIAN__)
constexpr bool kLittleEndian = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;
#else
constexpr bool kLittleEndian = false;  // the way that works everywhere
#endif

template <class Number>
Number loadLittle(const std::uint8_t* p) {
  Number value = 0;
  if constexpr (kLittleEndian) {
    std::memcpy(&value, p, sizeof value);
  } else {
    for (unsigned i = 0; i < sizeof value; ++i) {
      value = static_cast<Number>(value | (Number{p[i]} << (8 * i)));
    }
  }
  return value;
}

template <class Number>
void storeLittle(std::uint8_t* p, Number value) {
  if constexpr (kLittleEndian) {
    std::memcpy(p, &value, sizeof value);
  } else {
    for (unsigned i = 0; i < sizeof value; ++i) p[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

inline std::uint32_t loadLittle16(const std::uint8_t* p) { return loadLittle<std::uint16_t>(p); }
inline std::uint32_t loadLittle32(const std::uint8_t* p) { return loadLittle<std::uint32_t>(p); }
inline std::uint64_t loadLittle64(const std::uint8_t* p) { return loadLittle<std::uint64_t>(p); }
inline void storeLittle16(std::uint8_t* p, std::uint32_t value) {
  storeLittle(p, static_cast<std::uint16_t>(value));
}
inline void storeLittle64(std::uint8_t* p, std::uint64_t value) { storeLittle(p, value); }

}  // namespace bspc::geometry::fast
