#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "connectivity/half_edge_map.h"
#include "connectivity/open_gates.h"

namespace bspc::connectivity {

constexpr std::uint32_t kNoVertex = 0xFFFFFFFF;

struct Edge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// The faces that are known so far, and what follows from them: which edges are open, how many
/// faces each vertex has. It knows nothing of where vertices lie. The same on both sides.
class FaceFront {
 public:
  FaceFront(std::size_t vertices, bool triangles)
      : triangles_(triangles), gates_(vertices), valence_(vertices, 0), border_(vertices, 0) {}

  void addVertex();
  std::size_t vertices() const { return valence_.size(); }
  std::size_t faces() const { return faceEnds_.empty() ? corners_.size() / 3 : faceEnds_.size(); }
  const OpenGates& gates() const { return gates_; }
  bool triangles() const { return triangles_; }
  /// Faces at the vertex.
  std::uint32_t valence(std::uint32_t vertex) const { return valence_[vertex]; }

  /// Neither a face nor a border stands at the directed edge.
  bool free(std::uint32_t from, std::uint32_t to) const { return !halfEdges_.contains(from, to); }
  /// A face could be added along the edge: only its other side has one.
  bool isOpen(Edge edge) const { return free(edge.from, edge.to) && hasFace(edge.to, edge.from); }
  /// The vertex before `from` in the face that stands at the directed edge; kNoVertex if none does.
  std::uint32_t apexOf(std::uint32_t from, std::uint32_t to) const;
  /// The corner of a face that the directed edge leaves from, in allCorners(); kNoVertex if no face
  /// has the edge.
  std::uint32_t cornerAt(std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t corner = halfEdges_.find(from, to);
    return corner < kBorder ? corner : kNoVertex;
  }
  /// The next corner of the same face.
  std::uint32_t cornerAfter(std::uint32_t corner) const;
  /// The face at the directed edge, kNoVertex if there is none.
  std::uint32_t faceAt(std::uint32_t from, std::uint32_t to) const;
  /// Corners of a face.
  std::uint32_t corners(std::uint32_t face) const;

  /// Whether vertices may become a face: all differ, and every edge is free.
  bool fits(Span<const std::uint32_t> face) const;
  /// Adds a face that fits. `opened` receives the edges that are now open, in the face's order.
  void place(Span<const std::uint32_t> face, std::vector<Edge>& opened);
  /// No face comes at the open edge.
  void close(Edge edge);
  /// Whether a border ends (begins) at the vertex.
  bool borderEndsAt(std::uint32_t vertex) const { return (border_[vertex] & kEnds) != 0; }
  bool borderBeginsAt(std::uint32_t vertex) const { return (border_[vertex] & kBegins) != 0; }

  /// Vertices of all faces, one after the other.
  Span<const std::uint32_t> allCorners() const { return corners_; }
  std::uint32_t faceOf(std::uint32_t corner) const {
    return triangles_ ? corner / 3 : faceOf_[corner];
  }
  /// The first corner of a face; faces() for the end of the last one.
  std::uint32_t faceStart(std::uint32_t face) const {
    return triangles_ ? 3 * face : face == 0 ? 0 : faceEnds_[face - 1];
  }
  /// Memory that has been taken for faces.
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kBorder = 0xFFFFFFFE;
  static constexpr std::uint8_t kEnds = 1;
  static constexpr std::uint8_t kBegins = 2;

  bool hasFace(std::uint32_t from, std::uint32_t to) const {
    return halfEdges_.find(from, to) < kBorder;
  }

  bool triangles_;
  HalfEdgeMap halfEdges_;  ///< the corner that an edge leaves from, or kBorder
  OpenGates gates_;
  std::vector<std::uint32_t> valence_;
  std::vector<std::uint8_t> border_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> faceOf_;    ///< of each corner; empty if all faces are triangles
  std::vector<std::uint32_t> faceEnds_;  ///< likewise
};

}  // namespace bspc::connectivity
