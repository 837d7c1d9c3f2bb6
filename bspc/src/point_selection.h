#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/span.h"

namespace bspc {

/// Leaves the points of those ascending indices, with all that belongs to them.
void keepPoints(DecodedPoints& points, const std::vector<std::size_t>& kept);

/// Point j becomes point places[j], with all that belongs to it; a permutation.
void reorderPoints(DecodedPoints& points, Span<const std::uint32_t> places);

/// Appends points with the same arrays.
void appendPoints(DecodedPoints& to, DecodedPoints&& from);

/// Bytes that the points take in memory, with all that belongs to them.
std::uint64_t memoryOf(const DecodedPoints& points);

}  // namespace bspc
