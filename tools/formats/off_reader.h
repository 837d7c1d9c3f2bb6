#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens the vertices of a text OFF file of three dimensions, with normals (NOFF), colours (COFF)
/// or texture coordinates (STOFF) or without. Throws FormatError.
std::unique_ptr<PointStream> openOff(InputBuffer in);

}  // namespace bspc::formats
