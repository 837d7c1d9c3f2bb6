#include "formats/xyz_writer.h"

namespace bspc::formats {

namespace {

void writeNames(std::string& text, const ModelLayout& layout, char separator) {
  text += std::string("x") + separator + "y" + separator + "z";
  for (const ColumnLayout& column : layout.columns) text += separator + column.name;
  text += '\n';
}

}  // namespace

void writeXyzHeader(std::string& text, const ModelLayout& layout) {
  if (layout.columns.empty()) return;
  text += "# ";
  writeNames(text, layout, ' ');
}

void writeCsvHeader(std::string& text, const ModelLayout& layout) { writeNames(text, layout, ','); }

}  // namespace bspc::formats
