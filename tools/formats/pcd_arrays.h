#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bspc/arrays.h"

namespace bspc::formats {

struct PcdField;

/// An array and where the components of a tuple are in a point: component k is offsets[k] bytes
/// behind the start of field fields[k].
struct PcdArray {
  ArrayDescription array;
  std::vector<std::size_t> fields;
  std::vector<std::size_t> offsets;
};

/// A field that holds a colour in one number: blue in the lowest byte, then green, red, and alpha
/// in "rgba" or what nobody says in "rgb".
bool isPackedColour(const PcdField& field);

/// Name of the array with the highest byte of a field "rgb".
constexpr const char* kPcdColourPadding = "rgb_padding";

/// Makes arrays of all fields but the positions and padding: packed colours become "RGB" or "RGBA"
/// of three or four bytes, normal_x to normal_z "Normals" with components nx to nz, a field of
/// several numbers an array of as many components. Names of fields differ.
std::vector<PcdArray> pcdArrays(const std::vector<PcdField>& fields);

}  // namespace bspc::formats
