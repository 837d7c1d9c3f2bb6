#pragma once

#include <cstdint>

#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// Bytes that stand at the end of a record, compressed by zstd of that level if that makes them
/// fewer.
void writePacked(ByteWriter& out, ByteView bytes, int level);
/// Takes the rest of `in`. Output grows as it is decoded; more than `maxBytes` is
/// Error(LimitExceeded).
Bytes readPacked(ByteReader& in, std::uint64_t maxBytes);

}  // namespace bspc::container
