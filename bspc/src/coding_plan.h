#pragma once

#include <cstdint>

#include "bspc/encoder.h"
#include "geometry/geometry_method.h"

namespace bspc {

/// What an encoder decides before the first tile: from the wishes and the number of points.
struct CodingPlan {
  const geometry::GeometryMethod* method = nullptr;
  geometry::CodingWishes wishes;
  std::uint64_t tilePoints = 0;  ///< most points of a tile, at least 1
  unsigned layers = 1;
  unsigned arrayEffort = 2;  ///< as attributes::ArrayWishes has it
};

/// Throws Error(InvalidArgument) for wishes that contradict each other or are out of range.
CodingPlan planCoding(const EncodeOptions& options, std::uint64_t points);

}  // namespace bspc
