#pragma once

#include "attributes/array_coder.h"
#include "attributes/memory_budget.h"
#include "container/byte_reader.h"

namespace bspc::attributes {

// Method Quantised: floating-point numbers as multiples of a step.

/// An empty payload if the numbers are better coded without loss.
EncodedArray encodeQuantised(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                             const ArrayWishes& wishes);

/// Reads what follows the method. Fills in the new tuples of `numbers`, which has its size.
void decodeQuantised(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                     MemoryBudget& budget, Bytes& numbers);

}  // namespace bspc::attributes
