#pragma once

#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/mesh.h"
#include "bspc/span.h"

namespace bspc::connectivity {

/// Points at the same place seen as one vertex. Vertices are numbered by their first points; the
/// points of a vertex are its members, in order.
class Welding {
 public:
  explicit Welding(Span<const GridPoint> points);

  std::size_t points() const { return vertexOf_.size(); }
  std::size_t vertices() const { return firsts_.size() - 1; }
  std::uint32_t vertexOf(std::uint32_t point) const { return vertexOf_[point]; }
  Span<const std::uint32_t> members(std::uint32_t vertex) const {
    return {members_.data() + firsts_[vertex], firsts_[vertex + 1] - std::size_t{firsts_[vertex]}};
  }
  /// Place of a point among the members of its vertex.
  std::uint32_t memberOf(std::uint32_t point) const {
    return placeOf_[point] - firsts_[vertexOf_[point]];
  }
  /// No two points are at the same place.
  bool trivial() const { return vertices() == vertexOf_.size(); }

 private:
  std::vector<std::uint32_t> vertexOf_;
  std::vector<std::uint32_t> firsts_;
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> placeOf_;
};

}  // namespace bspc::connectivity
