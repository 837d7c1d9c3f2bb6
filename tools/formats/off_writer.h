#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes the vertices of an OFF file. Throws FormatError if the model has arrays.
std::unique_ptr<PointWriter> offWriter(const ModelLayout& layout);

}  // namespace bspc::formats
