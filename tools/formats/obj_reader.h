#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens the vertices of a Wavefront OBJ file. Throws FormatError.
std::unique_ptr<PointStream> openObj(InputBuffer in);

}  // namespace bspc::formats
