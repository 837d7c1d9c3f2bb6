#include "geometry/bsp/polyhedron.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "entropy/symbol_coder.h"

namespace bspc::geometry {

namespace {

constexpr std::uint8_t kNone = 0xFF;
/// Precision of the place of a crossing on its edge.
constexpr unsigned kShareBits = 30;
/// Volumes are exact while vertices are fewer than 2^so many units from the first.
constexpr unsigned kVolumeBits = 15;

}  // namespace

void Polyhedron::setBox(const GridPoint& extent) {
  vertices_ = 8;
  edges_ = 12;
  faces_ = 6;
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      vertex_[i][k] =
          ((i >> k) & 1) != 0 ? static_cast<std::int32_t>((extent[k] + 1) * kOneStep) : 0;
    }
  }
  // Faces 2k and 2k + 1 are those across axis k at its lower and upper end. An edge along axis k
  // at the lower end of axis a = k + 1 and of axis b = k + 2 has face 2a on its left, 2b on its
  // right; each step to an upper end turns the order round.
  unsigned e = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned a = (k + 1) % 3;
    const unsigned b = (k + 2) % 3;
    for (unsigned corner = 0; corner < 4; ++corner) {
      const unsigned onA = corner & 1;
      const unsigned onB = corner >> 1;
      const unsigned from = (onA << a) | (onB << b);
      const auto faceA = static_cast<std::uint8_t>(2 * a + onA);
      const auto faceB = static_cast<std::uint8_t>(2 * b + onB);
      const bool even = onA == onB;
      edge_[e++] = {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>(from | (1U << k)),
                    even ? faceA : faceB, even ? faceB : faceA};
    }
  }
  for (unsigned f = 0; f < 6; ++f) face_[f] = {{0, 0, 0}, 0, 0};
}

GridBox Polyhedron::gridBox(const GridBox& within, std::int64_t slack) const {
  GridBox box = within;
  for (std::size_t k = 0; k < 3; ++k) {
    std::int64_t least = vertex_[0][k];
    std::int64_t most = least;
    for (unsigned i = 1; i < vertices_; ++i) {
      least = std::min<std::int64_t>(least, vertex_[i][k]);
      most = std::max<std::int64_t>(most, vertex_[i][k]);
    }
    // Grid position p stands at p + ½.
    const std::int64_t first = -floorShift(-(least - kOneStep / 2 - slack), kFractionBits);
    const std::int64_t last = floorShift(most - kOneStep / 2 + slack, kFractionBits);
    if (first > last || first > box.upper[k] || last < std::int64_t{box.lower[k]}) {
      box.empty = true;
      return box;
    }
    if (first > box.lower[k]) box.lower[k] = static_cast<std::uint32_t>(first);
    if (last < box.upper[k]) box.upper[k] = static_cast<std::uint32_t>(last);
  }
  return box;
}

unsigned Polyhedron::volumeShift() const {
  std::int64_t reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::int64_t least = vertex_[0][k];
    std::int64_t most = least;
    for (unsigned i = 1; i < vertices_; ++i) {
      least = std::min<std::int64_t>(least, vertex_[i][k]);
      most = std::max<std::int64_t>(most, vertex_[i][k]);
    }
    reach = std::max(reach, most - least + 1);
  }
  const unsigned bits = entropy::bitLength(static_cast<std::uint64_t>(reach));
  return bits > kVolumeBits ? bits - kVolumeBits : 0;
}

// Sum over the faces of the volumes of the pyramids above them, with vertex 0 for apex. A face is
// fanned out from any of its vertices, r, into triangles r, from, to; so each edge counts once for
// the face on its left and once, turned round, for the one on its right.
std::int64_t Polyhedron::volume(unsigned shift) const {
  std::array<IntegerVector, kMaxVertices> relative;
  for (unsigned i = 0; i < vertices_; ++i) {
    const IntegerVector d = vertex(i) - vertex(0);
    relative[i] = {floorShift(d.x, shift), floorShift(d.y, shift), floorShift(d.z, shift)};
  }
  std::array<std::uint8_t, kMaxFaces> first;
  first.fill(kNone);
  std::int64_t sum = 0;
  for (unsigned e = 0; e < edges_; ++e) {
    const Edge& edge = edge_[e];
    if (first[edge.left] == kNone) first[edge.left] = edge.from;
    if (first[edge.right] == kNone) first[edge.right] = edge.from;
    const IntegerVector apart = relative[first[edge.left]] - relative[first[edge.right]];
    sum += dot(apart, cross(relative[edge.from], relative[edge.to]));
  }
  return sum < 0 ? -sum : sum;
}

bool Polyhedron::isBox() const {
  return std::all_of(face_.begin(), face_.begin() + faces_,
                     [](const Face& face) { return face.side == 0; });
}

bool Polyhedron::contains(const GridPoint& p) const {
  const std::int64_t x = 2 * std::int64_t{p[0]} + 1;
  const std::int64_t y = 2 * std::int64_t{p[1]} + 1;
  const std::int64_t z = 2 * std::int64_t{p[2]} + 1;
  for (unsigned f = 0; f < faces_; ++f) {
    const Face& face = face_[f];
    if (face.side == 0) continue;
    const bool front = face.normal[0] * x + face.normal[1] * y + face.normal[2] * z >= face.offset;
    if (front != (face.side > 0)) return false;
  }
  return true;
}

void Polyhedron::pack(std::vector<std::uint8_t>& bytes) const {
  static_assert(std::is_trivially_copyable_v<Face> && std::is_trivially_copyable_v<Edge>);
  bytes.resize(3 + vertices_ * sizeof(Vertex) + edges_ * sizeof(Edge) + faces_ * sizeof(Face));
  std::uint8_t* to = bytes.data();
  *to++ = static_cast<std::uint8_t>(vertices_);
  *to++ = static_cast<std::uint8_t>(edges_);
  *to++ = static_cast<std::uint8_t>(faces_);
  std::memcpy(to, vertex_.data(), vertices_ * sizeof(Vertex));
  to += vertices_ * sizeof(Vertex);
  std::memcpy(to, edge_.data(), edges_ * sizeof(Edge));
  to += edges_ * sizeof(Edge);
  std::memcpy(to, face_.data(), faces_ * sizeof(Face));
}

void Polyhedron::unpack(const std::vector<std::uint8_t>& bytes) {
  const std::uint8_t* from = bytes.data();
  vertices_ = *from++;
  edges_ = *from++;
  faces_ = *from++;
  std::memcpy(vertex_.data(), from, vertices_ * sizeof(Vertex));
  from += vertices_ * sizeof(Vertex);
  std::memcpy(edge_.data(), from, edges_ * sizeof(Edge));
  from += edges_ * sizeof(Edge);
  std::memcpy(face_.data(), from, faces_ * sizeof(Face));
}

PolyhedronCut::PolyhedronCut(const Polyhedron& whole, const CutPlane& plane, bool exact)
    : whole_(whole), plane_(plane), exact_(exact) {
  const IntegerVector normal{std::int64_t{2} * plane.normal[0], std::int64_t{2} * plane.normal[1],
                             std::int64_t{2} * plane.normal[2]};
  const std::int64_t offset = plane.offset * kOneStep;
  for (unsigned i = 0; i < whole.vertices_; ++i) {
    height_[i] = dot(normal, whole.vertex(i)) - offset;
    if (height_[i] >= 0) ++inFront_;
  }
  if (!hasFront() || !hasBack()) return;
  for (unsigned e = 0; e < whole.edges_; ++e) {
    const Polyhedron::Edge& edge = whole.edge_[e];
    if ((height_[edge.from] >= 0) != (height_[edge.to] >= 0)) cross(e);
  }
  fits_ = whole.vertices_ + crossings_ <= Polyhedron::kMaxVertices &&
          whole.edges_ + crossings_ <= Polyhedron::kMaxEdges &&
          whole.faces_ + 1 <= Polyhedron::kMaxFaces;
}

// Heights stay below 2^45. The share of the edge before the crossing has kShareBits bits; the
// heights are shortened first so that the quotient's numerator fits into 63.
void PolyhedronCut::cross(unsigned e) {
  const Polyhedron::Edge& edge = whole_.edge_[e];
  const std::int64_t from = height_[edge.from];
  const std::int64_t to = height_[edge.to];
  std::int64_t part = from < 0 ? -from : from;
  std::int64_t all = part + (to < 0 ? -to : to);
  const unsigned bits = entropy::bitLength(static_cast<std::uint64_t>(all));
  if (bits > 32) {
    part >>= bits - 32;
    all >>= bits - 32;
  }
  const std::int64_t share = (part << kShareBits) / all;
  const Polyhedron::Vertex& a = whole_.vertex_[edge.from];
  const Polyhedron::Vertex& b = whole_.vertex_[edge.to];
  Polyhedron::Vertex& at = crossing_[e];
  constexpr std::int64_t kHalf = std::int64_t{1} << (kShareBits - 1);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t step = (std::int64_t{b[k]} - a[k]) * share + kHalf;
    at[k] = static_cast<std::int32_t>(a[k] + floorShift(step, kShareBits));
    if (exact_ && plane_.normal[k] != 0) {
      at[k] = static_cast<std::int32_t>(plane_.offset / 2 * kOneStep);
    }
  }
  ++crossings_;
}

void PolyhedronCut::build(bool front, Polyhedron& out) const {
  std::array<std::uint8_t, Polyhedron::kMaxVertices> newVertex;
  std::array<std::uint8_t, Polyhedron::kMaxFaces> newFace;
  newFace.fill(kNone);
  out.vertices_ = out.edges_ = out.faces_ = 0;
  for (unsigned i = 0; i < whole_.vertices_; ++i) {
    if ((height_[i] >= 0) != front) {
      newVertex[i] = kNone;
      continue;
    }
    newVertex[i] = static_cast<std::uint8_t>(out.vertices_);
    out.vertex_[out.vertices_++] = whole_.vertex_[i];
  }
  const auto face = [&](std::uint8_t f) {
    if (newFace[f] == kNone) {
      newFace[f] = static_cast<std::uint8_t>(out.faces_);
      out.face_[out.faces_++] = whole_.face_[f];
    }
    return newFace[f];
  };
  // Going round a face against the clock, where this side is left and where it is entered again.
  std::array<Pass, Polyhedron::kMaxVertices> exits;
  std::array<Pass, Polyhedron::kMaxVertices> entries;
  unsigned passes = 0;
  for (unsigned e = 0; e < whole_.edges_; ++e) {
    const Polyhedron::Edge& edge = whole_.edge_[e];
    const std::uint8_t from = newVertex[edge.from];
    const std::uint8_t to = newVertex[edge.to];
    if (from == kNone && to == kNone) continue;
    const std::uint8_t left = face(edge.left);
    const std::uint8_t right = face(edge.right);
    if (from != kNone && to != kNone) {
      out.edge_[out.edges_++] = {from, to, left, right};
      continue;
    }
    const auto at = static_cast<std::uint8_t>(out.vertices_);
    out.vertex_[out.vertices_++] = crossing_[e];
    if (from != kNone) {
      out.edge_[out.edges_++] = {from, at, left, right};
      exits[passes] = {left, at};
      entries[passes++] = {right, at};
    } else {
      out.edge_[out.edges_++] = {at, to, left, right};
      exits[passes] = {right, at};
      entries[passes++] = {left, at};
    }
  }
  // The new face. Rounding may make a plane cross a face more than once; each exit is then joined
  // to some entry of its face, so that faces stay closed.
  const auto cap = static_cast<std::uint8_t>(out.faces_++);
  out.face_[cap] = {
      {static_cast<std::int16_t>(plane_.normal[0]), static_cast<std::int16_t>(plane_.normal[1]),
       static_cast<std::int16_t>(plane_.normal[2])},
      static_cast<std::int16_t>(exact_ ? 0 : (front ? 1 : -1)),
      plane_.offset};
  for (unsigned i = 0; i < passes; ++i) {
    for (unsigned j = 0; j < passes; ++j) {
      if (entries[j].face != exits[i].face) continue;
      out.edge_[out.edges_++] = {exits[i].vertex, entries[j].vertex, exits[i].face, cap};
      entries[j].face = kNone;
      break;
    }
  }
}

}  // namespace bspc::geometry
