#pragma once

#include <string>
#include <vector>

#include "bspc/point_set.h"
#include "formats/array_columns.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// How a point is written as a line of text.
struct LineStyle {
  const char* prefix = "";
  char separator = ' ';
  /// Whether texts may be put between quotation marks; else blanks in them become "_".
  bool quotes = false;
};

/// Writes one line a point: the prefix, its coordinates, its columns. Numbers are in the shortest
/// spelling that their type restores. Throws FormatError for a text with a line end in it.
void writePointLines(OutputBuffer& out, const PointSetView& points,
                     const std::vector<ArrayColumn>& columns, const LineStyle& style);

/// Appends a text so that readers take it for one field.
void appendField(std::string& line, const std::string& text, const LineStyle& style);

/// Throws FormatError if there are arrays, which `format` has no place for: "an OFF file".
void requireNoArrays(const std::vector<ArrayDescription>& arrays, const char* format);

}  // namespace bspc::formats
