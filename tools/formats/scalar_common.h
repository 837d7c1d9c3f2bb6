#pragma once

#include <array>

#include "bspc/scalar_type.h"

namespace bspc::formats {

/// The smallest type that holds the numbers of all three exactly; Float64 where there is none.
ScalarType commonScalarType(const std::array<ScalarType, 3>& types);

}  // namespace bspc::formats
