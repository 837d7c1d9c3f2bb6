#pragma once

#include "bspc/grid.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// The grid as it stands in the head (docs/format.md, "Grid").
void writeGrid(ByteWriter& out, const Grid& grid);
/// Throws Error(Corrupt) for values out of range, Error(Unsupported) for unknown types and forms.
Grid readGrid(ByteReader& in);

}  // namespace bspc::container
