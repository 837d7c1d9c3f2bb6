#pragma once

#include <string>

#include "formats/model.h"

namespace bspc::formats {

/// Writes what stands in front of the vertices of an OBJ file. Throws FormatError if the model
/// has columns.
void writeObjHeader(std::string& text, const ModelLayout& layout);

}  // namespace bspc::formats
