#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens a PLY file 1.0, ascii or binary of either byte order. Positions keep the type of the
/// properties x, y and z. Throws FormatError.
std::unique_ptr<PointStream> openPly(InputBuffer in);

}  // namespace bspc::formats
