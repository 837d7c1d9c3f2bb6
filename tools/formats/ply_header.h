#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bspc/scalar_type.h"
#include "formats/array_columns.h"
#include "formats/model.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

enum class PlyEncoding : std::uint8_t { Ascii, LittleEndian, BigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::Float32;
  bool isList = false;
  /// Type of the number of items in front of a list.
  ScalarType countType = ScalarType::UInt8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool hasList() const;
  /// Bytes of one element in a binary file, lists left out.
  std::uint64_t fixedBytes() const;
  /// Bytes that one element takes at the least.
  std::uint64_t leastBytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  /// Texts of the lines "comment" and "obj_info".
  std::vector<std::string> comments;
  std::vector<std::string> infos;
  /// Which element is "vertex", and which of its properties are x, y and z.
  std::size_t vertexElement = 0;
  std::array<std::size_t, 3> xyz{};
  /// The type that holds all three exactly.
  ScalarType positionType = ScalarType::Float32;
  /// The arrays that the other properties of the vertices are, lists left out.
  std::vector<GroupedColumns> arrays;

  const PlyElement& vertices() const { return elements[vertexElement]; }
};

/// Reads a header up to and with the line `end_header`; the input is left at the first byte behind
/// it. Throws FormatError.
PlyHeader readPlyHeader(TextScanner& text);

/// Which list property of an element has the vertices of faces; none if it is no element of faces.
std::optional<std::size_t> plyFaceList(const PlyElement& element);

/// What a file with this header holds that neither positions nor arrays are, nor faces if they are
/// kept.
std::vector<OtherContent> otherPlyContent(const PlyHeader& header, bool keepsFaces);

}  // namespace bspc::formats
