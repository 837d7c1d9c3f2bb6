#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes PCD 0.7, binary, in the types of positions and arrays. Colours of three or four bytes
/// become a packed field "rgb" or "rgba", normals normal_x to normal_z, other arrays a field of as
/// many numbers. Rows are those that the metadata tell, if the order of the points is kept.
std::unique_ptr<PointWriter> pcdWriter(const ModelLayout& layout);

}  // namespace bspc::formats
