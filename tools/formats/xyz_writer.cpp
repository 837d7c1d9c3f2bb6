#include "formats/xyz_writer.h"

#include <string>

#include "formats/array_columns.h"
#include "formats/point_lines.h"

namespace bspc::formats {

namespace {

constexpr LineStyle kBlanks{"", ' ', false};
constexpr LineStyle kCommas{"", ',', true};

class XyzWriter : public PointWriter {
 public:
  XyzWriter(const ModelLayout& layout, const LineStyle& style)
      : style_(style), columns_(columnsOf(layout.arrays)) {}

  void begin(OutputBuffer& out) override {
    const bool isCsv = style_.quotes;
    if (!isCsv && columns_.empty()) return;
    std::string& text = out.text();
    text += isCsv ? "" : "# ";
    text += std::string("x") + style_.separator + "y" + style_.separator + "z";
    for (const ArrayColumn& column : columns_) {
      text += style_.separator;
      appendField(text, column.name, style_);
    }
    text += '\n';
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writePointLines(out, points, columns_, style_);
  }

 private:
  LineStyle style_;
  std::vector<ArrayColumn> columns_;
};

}  // namespace

std::unique_ptr<PointWriter> xyzWriter(const ModelLayout& layout) {
  return std::make_unique<XyzWriter>(layout, kBlanks);
}

std::unique_ptr<PointWriter> csvWriter(const ModelLayout& layout) {
  return std::make_unique<XyzWriter>(layout, kCommas);
}

}  // namespace bspc::formats
