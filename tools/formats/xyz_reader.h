#pragma once

#include "formats/input_buffer.h"
#include "formats/model.h"

namespace bspc::formats {

/// Reads text with a point a line: XYZ, CSV and their like. Fields are separated by semicolons,
/// commas or blanks, whichever the first line shows; a first line of names says which columns are
/// x, y and z, else they are the first three. `#` starts a comment. Throws FormatError.
Model readXyz(InputBuffer& in);

}  // namespace bspc::formats
