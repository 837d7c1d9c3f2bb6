#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "connectivity/face_front.h"
#include "connectivity/vertex_index.h"

namespace bspc::connectivity {

/// Where the next vertex of a face is asked for: behind `from` → `to` in the order of the new face.
struct Gate {
  Edge edge;
  /// The third corner of the triangle on the other side of the edge, kNoVertex for the first edge
  /// of a component.
  std::uint32_t apex = kNoVertex;
  bool diagonal = false;  ///< that triangle is a part of the new face itself
  bool closing = true;    ///< the vertex asked for is the face's last one
  bool straight = false;  ///< the face across has four or more corners
};

/// A front over vertices whose places are known: those that can get no face are asleep in their
/// index.
class AdvancingFront : public FaceFront {
 public:
  AdvancingFront(Span<const Position> positions, VertexIndex& index, bool triangles)
      : FaceFront(positions.size(), triangles), positions_(positions), index_(index) {}

  const Position& position(std::uint32_t vertex) const { return positions_[vertex]; }
  const VertexIndex& index() const { return index_; }
  /// The gate at an open edge, or at a first edge if it has no face across.
  Gate gateAt(Edge edge) const;

  /// Adds a face that fits. `opened` receives the edges that are now open, in the face's order.
  void add(Span<const std::uint32_t> face, std::vector<Edge>& opened);
  /// No face comes at the open edge.
  void markBorder(Edge edge);
  /// The vertex has no face of this front: it will not be a candidate.
  void dismiss(std::uint32_t vertex) { index_.putToSleep(vertex); }

 private:
  /// A vertex with faces but no open gate is done.
  void settle(std::uint32_t vertex);

  Span<const Position> positions_;
  VertexIndex& index_;
};

}  // namespace bspc::connectivity
