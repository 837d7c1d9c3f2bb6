#pragma once

#include <cstdint>
#include <vector>

#include "attributes/neighbours.h"
#include "bspc/span.h"

namespace bspc::attributes {

// Method mixing: values 0 … 255 (colours, intensities) coded by what several contexts of neighbours
// and components before let expect.

/// Codes the bytes of the new points. `values` are those of all points by rank, `components` a
/// point; the first `limit` new points are coded.
Bytes writeMixed(const RankedPoints& points, const NeighbourTable& neighbours,
                 std::uint32_t components, std::vector<std::uint8_t>& values, std::size_t limit);

/// Fills in the bytes of the new points.
void readMixed(ByteView stream, const RankedPoints& points, const NeighbourTable& neighbours,
               std::uint32_t components, std::vector<std::uint8_t>& values);

}  // namespace bspc::attributes
