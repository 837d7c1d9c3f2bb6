#pragma once

#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// Writes an OBJ file of vertices. Throws FormatError if the model has columns.
void writeObj(OutputBuffer& out, const ModelView& model);

}  // namespace bspc::formats
