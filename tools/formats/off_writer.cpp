#include "formats/off_writer.h"

#include "formats/position_text.h"

namespace bspc::formats {

void writeOffHeader(std::string& text, const ModelLayout& layout) {
  requireNoColumns(layout, "OFF");
  text += "OFF\n" + std::to_string(layout.points) + " 0 0\n";
}

}  // namespace bspc::formats
