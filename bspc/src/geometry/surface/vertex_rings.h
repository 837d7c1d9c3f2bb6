#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "connectivity/face_front.h"
#include "connectivity/half_edge_map.h"
#include "connectivity/surface_faces.h"

namespace bspc::geometry::surface {

using connectivity::kNoVertex;

/// What lies around each vertex of a surface, whose faces are cut into fans of triangles.
class VertexRings {
 public:
  /// The side of a triangle that lies opposite a vertex, in the triangle's sense.
  struct Side {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
  };

  explicit VertexRings(const connectivity::SurfaceFaces& surface);

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(firstSide_.size() - 1); }
  /// Of all triangles of a vertex, in their order.
  Span<const Side> sides(std::uint32_t vertex) const {
    return Span<const Side>(sides_).subspan(firstSide_[vertex],
                                            firstSide_[vertex + 1] - firstSide_[vertex]);
  }
  /// Ascending, each once.
  Span<const std::uint32_t> neighbours(std::uint32_t vertex) const {
    return Span<const std::uint32_t>(neighbours_)
        .subspan(firstNeighbour_[vertex], firstNeighbour_[vertex + 1] - firstNeighbour_[vertex]);
  }
  /// The third vertex of the first triangle with that directed edge; kNoVertex if there is none.
  std::uint32_t third(std::uint32_t from, std::uint32_t to) const { return thirds_.find(from, to); }

  /// Memory that all this takes for so many vertices and corners of faces.
  static std::uint64_t bytesFor(std::uint64_t vertices, std::uint64_t corners) {
    return 32 * vertices + 180 * corners;
  }

 private:
  std::vector<std::size_t> firstSide_;
  std::vector<Side> sides_;
  std::vector<std::size_t> firstNeighbour_;
  std::vector<std::uint32_t> neighbours_;
  connectivity::HalfEdgeMap thirds_;
};

/// The vertices in the order in which they are coded: next is always the one of which most is known
/// from parallelograms of triangles, up to four; of equal ones the one that came so far first.
std::vector<std::uint32_t> sequenceOf(const VertexRings& rings);

}  // namespace bspc::geometry::surface
