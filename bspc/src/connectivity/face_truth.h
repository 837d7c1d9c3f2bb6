#pragma once

#include <cstdint>
#include <vector>

#include "bspc/mesh.h"
#include "connectivity/advancing_front.h"
#include "connectivity/half_edge_map.h"

namespace bspc::connectivity {

/// The faces that an encoder codes, as the front asks for them. No two of them have the same
/// directed edge, and no vertex stands twice in a face.
class FaceTruth {
 public:
  /// Views `faces`; flipped[i] says that face i has been turned around. `chosen`: those to code.
  FaceTruth(const Cells& faces, const std::vector<std::uint8_t>& flipped,
            const std::vector<std::uint32_t>& chosen, std::size_t vertices);

  bool hasFaceAt(Edge edge) const { return corners_.contains(edge.from, edge.to); }
  /// The first edge of face i of those that were given.
  Edge edgeOf(std::size_t i) const { return {faces_[i][0], faces_[i][1]}; }
  bool usesVertex(std::uint32_t vertex) const {
    return firstEdge_[vertex] != firstEdge_[vertex + 1];
  }
  /// A vertex that follows `vertex` in one of its faces: the nearest one if it is among them.
  std::uint32_t neighbour(std::uint32_t vertex, const std::vector<Neighbour>& nearest) const;
  /// Makes the face at the edge, from there on, the current one.
  void take(Edge edge);

  const std::vector<std::uint32_t>& face() const { return face_; }
  bool flipped() const { return flipped_[order_.back()] != 0; }
  /// The faces in the order in which they were taken.
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// Of each of them, the corner that it was taken from, in the faces that were given.
  const std::vector<std::uint32_t>& firstCorners() const { return firstCorners_; }

 private:
  const Cells& faces_;
  const std::vector<std::uint8_t>& flipped_;
  HalfEdgeMap corners_;                   ///< corner that the edge leaves from
  std::vector<std::uint32_t> faceOf_;     ///< of each corner
  std::vector<std::uint32_t> firstEdge_;  ///< of each vertex, in followers_
  std::vector<std::uint32_t> followers_;
  std::vector<std::uint32_t> face_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> firstCorners_;
};

/// What stands in its place at a decoder.
class UnknownFaces {
 public:
  bool hasFaceAt(Edge /*edge*/) const { return false; }
  Edge edgeOf(std::size_t /*i*/) const { return {}; }
  bool usesVertex(std::uint32_t /*vertex*/) const { return false; }
  std::uint32_t neighbour(std::uint32_t /*vertex*/, const std::vector<Neighbour>& /*n*/) const {
    return 0;
  }
  void take(Edge /*edge*/) {}
  const std::vector<std::uint32_t>& face() const { return face_; }
  bool flipped() const { return false; }

 private:
  std::vector<std::uint32_t> face_;
};

}  // namespace bspc::connectivity
