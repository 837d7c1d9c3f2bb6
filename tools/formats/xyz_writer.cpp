#include "formats/xyz_writer.h"

#include "formats/position_text.h"

namespace bspc::formats {

namespace {

void writeNames(std::string& text, const ModelView& model, char separator) {
  text += std::string("x") + separator + "y" + separator + "z";
  for (const PointColumn& column : model.columns) text += separator + column.name;
  text += '\n';
}

}  // namespace

void writeXyz(OutputBuffer& out, const ModelView& model) {
  if (!model.columns.empty()) {
    out.text() += "# ";
    writeNames(out.text(), model, ' ');
  }
  writePositionLines(out, model, "", ' ');
}

void writeCsv(OutputBuffer& out, const ModelView& model) {
  writeNames(out.text(), model, ',');
  writePositionLines(out, model, "", ',');
}

}  // namespace bspc::formats
