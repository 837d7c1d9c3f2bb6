#include "geometry/bsp/local_frame.h"

namespace bspc::geometry {

namespace {

/// The longest difference of two of the vertices as `project` shows them, and where it starts.
template <class Project>
IntegerVector longest(const Polyhedron& cell, unsigned& start, const Project& project) {
  std::int64_t best = -1;
  IntegerVector result;
  for (unsigned i = 0; i < cell.vertices(); ++i) {
    for (unsigned j = i + 1; j < cell.vertices(); ++j) {
      const IntegerVector d = project(cell.vertex(j) - cell.vertex(i));
      const std::int64_t square = dot(d, d);
      if (square <= best) continue;
      best = square;
      result = d;
      start = i;
    }
  }
  return result;
}

}  // namespace

LocalFrame LocalFrame::of(const Polyhedron& cell, bool oriented) {
  LocalFrame frame;
  unsigned start = 0;
  frame.diagonal = longest(cell, start, [](const IntegerVector& d) { return d; });
  frame.start = cell.vertex(start);
  frame.u = direction(frame.diagonal);
  if (!oriented) return frame;
  const IntegerVector& u = frame.u;
  const IntegerVector across = longest(cell, start, [&u](const IntegerVector& d) {
    const std::int64_t along = floorShift(dot(d, u), kUnitBits);
    return IntegerVector{d.x - floorShift(u.x * along, kUnitBits),
                         d.y - floorShift(u.y * along, kUnitBits),
                         d.z - floorShift(u.z * along, kUnitBits)};
  });
  frame.v = direction(across);
  const IntegerVector w = cross(u, frame.v);
  frame.w = {floorShift(w.x, kUnitBits), floorShift(w.y, kUnitBits), floorShift(w.z, kUnitBits)};
  return frame;
}

}  // namespace bspc::geometry
