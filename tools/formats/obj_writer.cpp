#include "formats/obj_writer.h"

#include "formats/position_text.h"

namespace bspc::formats {

void writeObj(OutputBuffer& out, const ModelView& model) {
  requireNoColumns(model, "OBJ");
  out.text() += "# written by bspc\n";
  writePositionLines(out, model, "v ", ' ');
}

}  // namespace bspc::formats
