#include "formats/point_lines.h"

#include <algorithm>
#include <array>

#include "formats/model.h"
#include "formats/number_text.h"
#include "formats/record_writer.h"
#include "formats/scalar_visit.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

void appendScalar(std::string& line, const ScalarSource& source, std::uint64_t index) {
  const auto* at = static_cast<const std::uint8_t*>(source.data) + index * source.stride;
  visitScalar(source.type, [&](auto zero) { appendNumber(line, loadScalar<decltype(zero)>(at)); });
}

const std::string& textOf(const ArrayView& array, std::uint64_t index, std::size_t component) {
  const std::size_t stride =
      array.strideBytes > 0 ? array.strideBytes : array.components * sizeof(std::string);
  const auto* at = static_cast<const std::uint8_t*>(array.data) + index * stride;
  return reinterpret_cast<const std::string*>(at)[component];
}

}  // namespace

void writePointLines(OutputBuffer& out, const PointSetView& points,
                     const std::vector<ArrayColumn>& columns, const LineStyle& style) {
  std::array<ScalarSource, 3> xyz;
  for (std::size_t k = 0; k < 3; ++k) xyz[k] = coordinatesOf(points, k);
  std::vector<ScalarSource> sources(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].type == ScalarType::String) continue;
    sources[c] = componentOf(points.arrays()[columns[c].array], columns[c].component);
  }
  for (std::uint64_t i = 0; i < points.size(); ++i) {
    std::string& text = out.text();
    text += style.prefix;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0) text += style.separator;
      appendScalar(text, xyz[k], i);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += style.separator;
      if (columns[c].type == ScalarType::String) {
        const ArrayView& array = points.arrays()[columns[c].array];
        appendField(text, textOf(array, i, columns[c].component), style);
      } else {
        appendScalar(text, sources[c], i);
      }
    }
    text += '\n';
    out.advance(i + 1, points.size());
  }
}

void appendField(std::string& line, const std::string& text, const LineStyle& style) {
  if (text.find_first_of("\r\n") != std::string::npos) {
    throw FormatError("the text " + quoted(text) + " has a line end in it, which no line can hold");
  }
  if (!style.quotes) {
    // A word cannot be nothing, and # would start a comment.
    std::string word = text.empty() ? "_" : wordOf(text);
    std::replace(word.begin(), word.end(), '#', '_');
    line += word;
    return;
  }
  const std::string special = std::string("\"# \t;,") + style.separator;
  if (text.find_first_of(special) == std::string::npos && !text.empty()) {
    line += text;
    return;
  }
  line += '"';
  for (const char c : text) line += c == '"' ? "\"\"" : std::string(1, c);
  line += '"';
}

void requireNoArrays(const std::vector<ArrayDescription>& arrays, const char* format) {
  if (arrays.empty()) return;
  throw FormatError(std::string(format) + " has no place for the array " +
                    quoted(arrays.front().name) + "; PLY, XYZ, CSV, LAS and PCD files do");
}

}  // namespace bspc::formats
