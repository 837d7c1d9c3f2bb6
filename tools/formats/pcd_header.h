#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/scalar_type.h"
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
  /// What a file with this header holds beside positions, as phrases for ModelInfo::otherContent.
  std::vector<std::string> otherContent;

  const PcdField& axis(std::size_t k) const { return fields[xyz[k]]; }
};

/// Reads a header up to and with the line DATA; the input is left at the first byte behind it.
/// Throws FormatError.
PcdHeader readPcdHeader(TextScanner& text);

}  // namespace bspc::formats
