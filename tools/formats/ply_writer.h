#pragma once

#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// Writes the header of a PLY file, binary_little_endian, in the type of the positions; 64-bit
/// integers, which PLY has not, as doubles, and columns as uint or, if that is too small, double.
void writePlyHeader(std::string& text, const ModelLayout& layout);

/// Writes points behind the header. Throws FormatError for an integer that a double does not hold.
void writePlyRecords(OutputBuffer& out, const ModelLayout& layout, const ModelView& model);

}  // namespace bspc::formats
