#include "formats/off_writer.h"

#include "formats/position_text.h"

namespace bspc::formats {

void writeOff(OutputBuffer& out, const ModelView& model) {
  requireNoColumns(model, "OFF");
  out.text() += "OFF\n" + std::to_string(model.points.size()) + " 0 0\n";
  writePositionLines(out, model, "", ' ');
}

}  // namespace bspc::formats
