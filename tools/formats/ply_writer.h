#pragma once

#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// Writes a PLY file, binary_little_endian, in the type of the positions; 64-bit integers, which
/// PLY has not, as doubles. Throws FormatError for one that a double does not hold.
void writePly(OutputBuffer& out, const ModelView& model);

}  // namespace bspc::formats
