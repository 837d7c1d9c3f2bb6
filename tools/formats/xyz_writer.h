#pragma once

#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// Writes a point a line, coordinates and columns separated by blanks; columns are named in a first
/// line, which is a comment. Throws FormatError if the stream fails.
void writeXyz(OutputBuffer& out, const ModelView& model);

/// Writes a point a line, separated by commas, below a line of names.
void writeCsv(OutputBuffer& out, const ModelView& model);

}  // namespace bspc::formats
