#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "geometry/bsp/integer_vector.h"

namespace bspc::geometry {

/// A plane that cuts a cell. The grid point p, which stands in the middle of its grid cell, lies in
/// front if normal · (2p + 1) ≥ offset. This test alone decides where points belong.
struct CutPlane {
  std::array<std::int32_t, 3> normal{};
  std::int64_t offset = 0;

  bool inFront(const GridPoint& p) const {
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += normal[k] * (2 * std::int64_t{p[k]} + 1);
    return sum >= offset;
  }
  /// Between the grid positions at − 1 and at along an axis.
  static CutPlane across(unsigned axis, std::uint32_t at) {
    CutPlane plane;
    plane.normal[axis] = 1;
    plane.offset = 2 * std::int64_t{at};
    return plane;
  }
};

/// Part of the grid, both ends included.
struct GridBox {
  GridPoint lower{};
  GridPoint upper{};
  bool empty = false;

  std::uint64_t side(unsigned axis) const { return std::uint64_t{upper[axis]} - lower[axis] + 1; }
  /// Grid positions in it, at most 2^63.
  std::uint64_t volume() const { return empty ? 0 : side(0) * side(1) * side(2); }
  unsigned longestAxis() const {
    unsigned axis = 0;
    for (unsigned k = 1; k < 3; ++k) {
      if (side(k) > side(axis)) axis = k;
    }
    return axis;
  }
  GridPoint middle() const {
    GridPoint m;
    for (std::size_t k = 0; k < 3; ++k) m[k] = lower[k] + (upper[k] - lower[k]) / 2;
    return m;
  }
  bool contains(const GridPoint& p) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (p[k] < lower[k] || p[k] > upper[k]) return false;
    }
    return !empty;
  }
};

/// A cell of method bsp: vertices in units of 2^-kFractionBits steps and directed edges, each
/// between the face on its left and the face on its right. Vertices are rounded, so the faces are
/// not quite flat; the exact cell is what the planes of its faces say.
class Polyhedron {
 public:
  static constexpr unsigned kMaxVertices = 64;
  static constexpr unsigned kMaxEdges = 128;
  static constexpr unsigned kMaxFaces = 48;

  using Vertex = std::array<std::int32_t, 3>;
  struct Edge {
    std::uint8_t from;
    std::uint8_t to;
    std::uint8_t left;
    std::uint8_t right;
  };
  /// `side` is 1 if the cell lies in front of the plane, −1 if behind it, and 0 for planes across
  /// an axis, which the cell's grid box speaks for.
  struct Face {
    std::array<std::int16_t, 3> normal;
    std::int16_t side;
    std::int64_t offset;
  };

  /// The box of the grid positions 0 … extent.
  void setBox(const GridPoint& extent);

  unsigned vertices() const { return vertices_; }
  IntegerVector vertex(unsigned i) const { return {vertex_[i][0], vertex_[i][1], vertex_[i][2]}; }

  /// Grid positions that the cell may hold, given that they lie in `within`: the box of the
  /// vertices, `slack` wider (in the vertices' units) to make up for their rounding.
  GridBox gridBox(const GridBox& within, std::int64_t slack) const;

  /// Six times the volume, in units that get coarser the larger the cell is.
  std::int64_t volume(unsigned shift) const;
  /// The shift at which volume() cannot overflow for this cell and for any part of it.
  unsigned volumeShift() const;

  /// Whether all faces lie across axes, so that the grid box says everything.
  bool isBox() const;

  /// Whether the planes of all faces have the point on the cell's side.
  bool contains(const GridPoint& p) const;

  void pack(std::vector<std::uint8_t>& bytes) const;
  void unpack(const std::vector<std::uint8_t>& bytes);

 private:
  friend class PolyhedronCut;

  unsigned vertices_ = 0;
  unsigned edges_ = 0;
  unsigned faces_ = 0;
  std::array<Vertex, kMaxVertices> vertex_;
  std::array<Edge, kMaxEdges> edge_;
  std::array<Face, kMaxFaces> face_;
};

/// A polyhedron cut in two.
class PolyhedronCut {
 public:
  /// `exact` marks a plane across an axis.
  PolyhedronCut(const Polyhedron& whole, const CutPlane& plane, bool exact);

  bool hasFront() const { return inFront_ > 0; }
  bool hasBack() const { return inFront_ < whole_.vertices_; }
  /// False if a side might need more than a Polyhedron holds.
  bool fits() const { return fits_; }
  /// Writes one of the sides, which must not be the whole.
  void build(bool front, Polyhedron& out) const;

 private:
  struct Pass {
    std::uint8_t face;
    std::uint8_t vertex;
  };

  void cross(unsigned edge);

  const Polyhedron& whole_;
  const CutPlane& plane_;
  bool exact_;
  bool fits_ = true;
  unsigned inFront_ = 0;
  unsigned crossings_ = 0;
  std::array<std::int64_t, Polyhedron::kMaxVertices> height_;
  std::array<Polyhedron::Vertex, Polyhedron::kMaxEdges> crossing_;
};

}  // namespace bspc::geometry
