#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens text with a point a line: XYZ, CSV and their like. Fields are separated by semicolons,
/// commas or blanks, whichever the first line shows; a first line of names, or a comment of as many
/// names in front of the points, says which columns are x, y and z and names the others, which
/// become arrays; else the first three columns are the positions. `#` starts a comment. Throws
/// FormatError.
std::unique_ptr<PointStream> openXyz(InputBuffer in);

}  // namespace bspc::formats
