#pragma once

#include "attributes/array_coder.h"
#include "attributes/memory_budget.h"
#include "container/byte_reader.h"

namespace bspc::attributes {

// Method Strings.

EncodedArray encodeStrings(const ArrayShape& shape, const std::vector<std::string>& strings,
                           TilePoints& points, unsigned effort);

/// Reads what follows the method. Appends the strings of the new points.
void decodeStrings(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                   MemoryBudget& budget, std::vector<std::string>& strings);

}  // namespace bspc::attributes
