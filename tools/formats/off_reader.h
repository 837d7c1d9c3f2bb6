#pragma once

#include "formats/input_buffer.h"
#include "formats/model.h"

namespace bspc::formats {

/// Reads the vertices of a text OFF file of three dimensions, with normals (NOFF), colours (COFF)
/// or texture coordinates (STOFF) or without. Throws FormatError.
Model readOff(InputBuffer& in);

}  // namespace bspc::formats
