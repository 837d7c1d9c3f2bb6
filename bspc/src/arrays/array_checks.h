#pragma once

#include "bspc/encoder.h"
#include "bspc/point_set.h"

namespace bspc {

/// Throws Error(InvalidArgument) naming the array and what is wrong with it.
void checkDescription(const ArrayDescription& array);

/// Likewise for the arrays of a set of `points` points, and for what the options add.
void checkArrays(Span<const ArrayView> arrays, std::uint64_t points, const EncodeOptions& options);

/// Likewise for arrays whose values are still to come.
void checkDescriptions(const std::vector<ArrayDescription>& arrays, const EncodeOptions& options);

/// Likewise for the arrays of so many cells of a mesh.
void checkCellArrays(Span<const ArrayView> arrays, std::uint64_t cells);

/// Throws Error(InvalidArgument) for keys or field arrays that come twice or make no sense.
void checkMetadata(const Metadata& metadata);

}  // namespace bspc
