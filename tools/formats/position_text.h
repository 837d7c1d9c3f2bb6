#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "formats/model.h"

namespace bspc::formats {

/// The type of positions that come from text: a double holds every decimal that a float32 or a
/// double was written as.
constexpr ScalarType kTextType = ScalarType::Float64;

/// Stores point number `index` of a block whose type is kTextType.
inline void storePosition(std::uint8_t* positions, std::size_t index,
                          const std::array<double, 3>& position) {
  std::memcpy(positions + index * sizeof(position), position.data(), sizeof(position));
}

}  // namespace bspc::formats
