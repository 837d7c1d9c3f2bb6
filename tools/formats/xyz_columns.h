#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/array_columns.h"
#include "formats/input_buffer.h"
#include "formats/xyz_layout.h"

namespace bspc::formats {

/// Makes arrays of the named columns beside x, y and z, of types that their texts show: whole
/// numbers become Int32, or Int64 or UInt64 where that is too small; colours from 0 to 255 UInt8
/// and to 65,535 UInt16; other numbers, with nothing for NaN, Float64; anything else String.
///
/// Looks at all lines from the scanner's on if the input can go back, else at those of its first
/// four megabytes. `text` reads `in` and stands at the first point, where it is left; members of
/// the groups are numbers of columns in the file.
std::vector<GroupedColumns> readXyzColumns(InputBuffer& in, TextScanner& text,
                                           const XyzLayout& layout);

}  // namespace bspc::formats
