#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens a LAS file 1.0 to 1.4 of any point format, not compressed (LAZ is refused by name).
/// Positions are the float64 numbers X * scale + offset, computed as the specification writes them,
/// which is also what info().lattice restores. Throws FormatError.
std::unique_ptr<PointStream> openLas(InputBuffer in);

}  // namespace bspc::formats
