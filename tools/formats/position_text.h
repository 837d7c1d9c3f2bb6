#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// The type of positions that come from text: a double holds every decimal that a float32 or a
/// double was written as.
constexpr ScalarType kTextType = ScalarType::Float64;

/// Stores point number `index` of a block whose type is kTextType.
inline void storePosition(std::uint8_t* positions, std::size_t index,
                          const std::array<double, 3>& position) {
  std::memcpy(positions + index * sizeof(position), position.data(), sizeof(position));
}

/// Appends the three coordinates of point `index`, in the shortest spelling that its type restores.
void appendPosition(std::string& text, const PointSetView& points, std::uint64_t index,
                    char separator);

/// Throws FormatError if the model has columns, which `format` has no place for.
void requireNoColumns(const ModelLayout& model, const char* format);

/// Writes one line a point: `prefix`, its coordinates, its values of the columns.
void writePositionLines(OutputBuffer& out, const ModelView& model, const char* prefix,
                        char separator);

}  // namespace bspc::formats
