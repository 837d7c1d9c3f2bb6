#pragma once

#include "arrays/array_source.h"
#include "bspc/encoder.h"
#include "container/file_head.h"

namespace bspc {

/// The head of a file whose grid and layers the report says, without tiles; names the arrays in
/// the report.
container::FileHead beginFile(const ArraySource& arrays, const EncodeOptions& options,
                              EncodeReport& report);

/// Throws Error(InvalidArgument) if lossy stops are asked for on a grid of exact floats.
void refuseStopsOnFloats(const Grid& grid, const EncodeOptions& options);

}  // namespace bspc
