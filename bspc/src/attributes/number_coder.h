#pragma once

#include <cstdint>

#include "attributes/array_payload.h"
#include "attributes/tile_points.h"
#include "bspc/span.h"

namespace bspc::attributes {

// Arrays of numbers without loss: methods Constant, Bytes, Quick, Residual, Mixing, Categories.

/// Codes the tuples of new points; `numbers` holds those of all points, in decoded order.
Bytes encodeNumbers(const NumberShape& shape, const Bytes& numbers, TilePoints& points,
                    unsigned effort);

/// Fills in the tuples of new points; `numbers` has its size for all points.
void decodeNumbers(const NumberShape& shape, container::ByteReader& in, TilePoints& points,
                   MemoryBudget& budget, Bytes& numbers);

/// Whether decoding what encodeNumbers() wrote needs the order of the input.
bool followsInput(ByteView payload);

/// Calls f with a value of the unsigned type of so many bytes.
template <class F>
auto withWord(std::size_t size, F&& f) {
  switch (size) {
    case 1:
      return f(std::uint8_t{});
    case 2:
      return f(std::uint16_t{});
    case 4:
      return f(std::uint32_t{});
    default:
      return f(std::uint64_t{});
  }
}

}  // namespace bspc::attributes
