#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/scalar_type.h"
#include "formats/pcd_arrays.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

enum class PcdEncoding : std::uint8_t { Ascii, Binary, BinaryCompressed };

struct PcdField {
  std::string name;
  ScalarType type = ScalarType::Float32;
  /// Numbers of the field in a point.
  std::uint64_t count = 1;
  /// Bytes and numbers of a point in front of this field.
  std::uint64_t byteOffset = 0;
  std::uint64_t numberOffset = 0;
};

struct PcdHeader {
  PcdEncoding encoding = PcdEncoding::Ascii;
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  /// Bytes of a point in a binary file, and numbers of a point in a text.
  std::uint64_t pointBytes = 0;
  std::uint64_t pointNumbers = 0;
  /// Which fields are x, y and z.
  std::array<std::size_t, 3> xyz{};
  /// The type that holds all three exactly.
  ScalarType positionType = ScalarType::Float32;
  /// The arrays that the other fields are.
  std::vector<PcdArray> arrays;
  /// Rows of an organised cloud and the points of each; 1 row if it is none.
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  /// The seven numbers of the line VIEWPOINT; empty if they are those that say nothing.
  std::string viewpoint;

  const PcdField& axis(std::size_t k) const { return fields[xyz[k]]; }
};

/// Reads a header up to and with the line DATA; the input is left at the first byte behind it.
/// Throws FormatError.
PcdHeader readPcdHeader(TextScanner& text);

}  // namespace bspc::formats
