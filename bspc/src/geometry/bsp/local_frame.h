#pragma once

#include "geometry/bsp/polyhedron.h"

namespace bspc::geometry {

/// The frame in which a cell's cut plane is described (the paper's section on coding): u along the
/// biggest diagonal of the cell, v along the biggest diagonal of its projection along u, w = u × v;
/// of equal ones the first pair of vertices in order. Directions are in units of 2^-kUnitBits.
struct LocalFrame {
  IntegerVector start;     ///< of the biggest diagonal: P
  IntegerVector diagonal;  ///< PQ
  IntegerVector u;
  IntegerVector v;
  IntegerVector w;

  /// v and w are left out unless `oriented`.
  static LocalFrame of(const Polyhedron& cell, bool oriented);
};

}  // namespace bspc::geometry
