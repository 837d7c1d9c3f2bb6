#pragma once

#include <cstdint>

#include "bspc/arrays.h"
#include "bspc/limits.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// What the head says beside the points (docs/format.md, "Metadata"), compressed where that helps.
void writeMetadata(ByteWriter& out, const Metadata& metadata);
/// Takes the rest of `in`. Throws Error(Corrupt, Unsupported, LimitExceeded).
Metadata readMetadata(ByteReader& in, const DecodeLimits& limits);

}  // namespace bspc::container
