#pragma once

#include <memory>

#include "formats/input_buffer.h"
#include "formats/point_stream.h"

namespace bspc::formats {

/// Opens a PCD file of the Point Cloud Library: ascii, binary or binary_compressed. Positions keep
/// the type of the fields x, y and z. Of a compressed file, all points are in memory while it is
/// read, since it stores field after field. Throws FormatError.
std::unique_ptr<PointStream> openPcd(InputBuffer in);

}  // namespace bspc::formats
