#include "formats/position_text.h"

#include "formats/number_text.h"
#include "formats/scalar_visit.h"
#include "formats/wording.h"

namespace bspc::formats {

void appendPosition(std::string& text, const PointSetView& points, std::uint64_t index,
                    char separator) {
  visitScalar(points.type(), [&](auto zero) {
    using T = decltype(zero);
    const auto* at = static_cast<const std::uint8_t*>(points.data()) + index * points.strideBytes();
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0) text += separator;
      appendNumber(text, loadScalar<T>(at + k * sizeof(T)));
    }
  });
}

void requireNoColumns(const ModelLayout& model, const char* format) {
  if (model.columns.empty()) return;
  throw FormatError("an " + std::string(format) + " file has no place for " +
                    quoted(model.columns.front().name) + "; PLY, XYZ and CSV files do");
}

void writePositionLines(OutputBuffer& out, const ModelView& model, const char* prefix,
                        char separator) {
  for (std::uint64_t i = 0; i < model.points.size(); ++i) {
    std::string& text = out.text();
    text += prefix;
    appendPosition(text, model.points, i, separator);
    for (const PointColumn& column : model.columns) {
      text += separator;
      appendNumber(text, column.values[i]);
    }
    text += '\n';
    out.advance(i + 1, model.points.size());
  }
}

}  // namespace bspc::formats
