#pragma once

#include "attributes/array_coder.h"
#include "attributes/memory_budget.h"
#include "container/byte_reader.h"

namespace bspc::attributes {

// Method Sphere: unit vectors as places on an octahedron.

/// An empty payload if the vectors are better coded without loss.
EncodedArray encodeSphere(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                          const ArrayWishes& wishes);

/// Reads what follows the method. Fills in the new tuples of `numbers`, which has its size.
void decodeSphere(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                  MemoryBudget& budget, Bytes& numbers);

}  // namespace bspc::attributes
