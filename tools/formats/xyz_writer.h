#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes a point a line with blanks between; a comment in front names the columns if there are any
/// beside x, y and z.
std::unique_ptr<PointWriter> xyzWriter(const ModelLayout& layout);

/// Writes a line of names and a point a line with commas between.
std::unique_ptr<PointWriter> csvWriter(const ModelLayout& layout);

}  // namespace bspc::formats
