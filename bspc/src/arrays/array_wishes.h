#pragma once

#include "attributes/array_coder.h"
#include "bspc/arrays.h"

namespace bspc {

/// What the coder of an array may do: the tolerance of normals is an angle.
inline attributes::ArrayWishes wishesFor(const ArrayDescription& array, unsigned effort) {
  attributes::ArrayWishes wishes;
  wishes.effort = effort;
  const bool normals = array.semantic == Semantic::Normals && array.components == 3;
  (normals ? wishes.maxAngle : wishes.maxError) = array.tolerance;
  return wishes;
}

}  // namespace bspc
