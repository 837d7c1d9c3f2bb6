#pragma once

#include "formats/input_buffer.h"
#include "formats/model.h"

namespace bspc::formats {

/// Reads a PLY file 1.0, ascii or binary of either byte order. Positions keep the type of the
/// properties x, y and z. Throws FormatError.
Model readPly(InputBuffer& in);

}  // namespace bspc::formats
