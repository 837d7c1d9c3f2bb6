#pragma once

#include <memory>

#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes OBJ vertices, with their colours if the one array of the model is that and of floating
/// point. Throws FormatError if it has other arrays.
std::unique_ptr<PointWriter> objWriter(const ModelLayout& layout);

}  // namespace bspc::formats
