#pragma once

#include "target.h"

namespace bspc::fuzz {

/// Changes one thing or a few of a .bspc file (a payload, a field of a record, a block, bytes of a
/// head, the order of things), then makes sizes and checksums right, so that decoders get to see
/// it; now and then bytes anywhere. Takes any bytes.
Bytes mutateFile(ByteView file, std::size_t maxSize, Random& random, ByteMutator changeBytes);

}  // namespace bspc::fuzz
