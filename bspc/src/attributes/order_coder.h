#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// Codes the order in which the points of a tile came in: order[j] is the input index, 0 … n − 1,
/// of decoded point j. Both sides know all positions. The path of the input through the points is
/// followed, so scans cost little; points in random order cost log2(n!) bits.
///
/// Throws Error(InvalidArgument) if `order` is not a permutation of as many indices as there are
/// points.
Bytes encodeOrder(Span<const GridPoint> points, Span<const std::uint32_t> order);

/// The order that was coded. `maxBytes` bounds the memory. Throws Error(Corrupt, Unsupported,
/// LimitExceeded); any bytes are safe, and what comes back is always a permutation.
std::vector<std::uint32_t> decodeOrder(Span<const GridPoint> points, ByteView payload,
                                       std::uint64_t maxBytes);

}  // namespace bspc::attributes
