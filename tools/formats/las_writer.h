#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes LAS 1.2 to 1.4 as planLas() says. Positions that are not on its scale are rounded to it,
/// and greatestError() tells how far; FormatError is thrown for a value that its field is too small
/// for. The counts by return in the header are filled in if the layout says that the stream can go
/// back, else they are 0.
std::unique_ptr<PointWriter> lasWriter(const ModelLayout& layout);

}  // namespace bspc::formats
