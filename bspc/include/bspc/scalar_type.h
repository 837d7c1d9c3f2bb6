#pragma once

#include <cstddef>
#include <cstdint>

namespace bspc {

/// Type of one stored number. The values are those of the file format (docs/format.md, "Scalar
/// types"). Positions use the first ten; Bit and String exist for named arrays only.
enum class ScalarType : std::uint8_t {
  Float32 = 0,
  Float64 = 1,
  Int8 = 2,
  UInt8 = 3,
  Int16 = 4,
  UInt16 = 5,
  Int32 = 6,
  UInt32 = 7,
  Int64 = 8,
  UInt64 = 9,
  Bit = 10,
  String = 11,
};

constexpr std::uint8_t kPositionTypeCount = 10;

/// Bytes of one number in memory; 0 for Bit and String, which have no fixed element size.
std::size_t scalarSize(ScalarType type);

/// "float32", "uint8", … as printed to people.
const char* scalarName(ScalarType type);

constexpr bool isFloatingPoint(ScalarType type) {
  return type == ScalarType::Float32 || type == ScalarType::Float64;
}

}  // namespace bspc
