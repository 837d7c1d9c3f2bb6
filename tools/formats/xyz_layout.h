#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/text_scanner.h"

namespace bspc::formats {

/// What the first lines of a text with a point a line say of its columns.
struct XyzLayout {
  char separator = ' ';
  /// Names of the columns, all of them different; empty if the text has none.
  std::vector<std::string> names;
  /// Which coordinate each column is, 3 for none.
  std::vector<std::size_t> axisOf;
  /// Whether the scanner is at a point, not at names or at the end.
  bool atPoint = false;
};

/// Reads up to the first point. Throws FormatError.
XyzLayout readXyzLayout(TextScanner& text);

/// Moves to the next line with something in it beside a comment; false at the end of the text.
bool nextXyzContent(TextScanner& text, char separator);

/// The field without quotation marks around it, in which two are one.
std::string unquotedField(std::string_view field);

}  // namespace bspc::formats
