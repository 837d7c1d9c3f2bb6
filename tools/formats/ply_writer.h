#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes PLY, binary_little_endian, in the types of positions and arrays; 64-bit integers, which
/// PLY has not, become doubles, and FormatError is thrown for one that a double does not hold.
/// Properties are named as columnsOf() says.
std::unique_ptr<PointWriter> plyWriter(const ModelLayout& layout);

}  // namespace bspc::formats
