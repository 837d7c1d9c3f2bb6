#include "formats/obj_writer.h"

#include "formats/position_text.h"

namespace bspc::formats {

void writeObjHeader(std::string& text, const ModelLayout& layout) {
  requireNoColumns(layout, "OBJ");
  text += "# written by bspc\n";
}

}  // namespace bspc::formats
