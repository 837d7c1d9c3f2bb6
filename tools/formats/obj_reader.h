#pragma once

#include "formats/input_buffer.h"
#include "formats/model.h"

namespace bspc::formats {

/// Reads the vertices of a Wavefront OBJ file. Throws FormatError.
Model readObj(InputBuffer& in);

}  // namespace bspc::formats
