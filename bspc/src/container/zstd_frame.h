#pragma once

#include "bspc/span.h"
#include "container/byte_reader.h"

namespace bspc::container {

/// A frame needs a window of at most 8 MiB, with which every level of zstd but its "ultra" ones is
/// content, so that readers need not keep more of what they have decompressed.
constexpr unsigned kFrameWindowLog = 23;

/// Throws Error(Corrupt) through `in` unless the bytes are one whole zstd frame such as the format
/// allows: not a skippable one, without a dictionary, of a window that is not too large.
void checkFrame(const ByteReader& in, ByteView frame);

}  // namespace bspc::container
