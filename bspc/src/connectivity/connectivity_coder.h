#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bspc/grid.h"
#include "bspc/mesh.h"
#include "bspc/span.h"

namespace bspc::connectivity {

/// Where the points are: both sides know them.
struct MeshPoints {
  Span<const GridPoint> points;
  /// Lengths of the grid's steps along the axes; only their ratios matter.
  std::array<double, 3> steps{1, 1, 1};
};

struct CodingWishes {
  unsigned effort = 9;  ///< 1 … 4: quick; 5 … 9: small
  /// Cells come back in their order, and each with its vertices from the first one on.
  bool keepOrder = false;
  /// Points at the same place may change their numbers (EncodedMesh::pointOrder).
  bool mayRenumber = false;
};

struct EncodedMesh {
  Bytes payload;
  /// Input number of the j-th vertex cell, and of the j-th face, that a decoder returns; empty if
  /// that is j. Lines keep their order.
  std::vector<std::uint32_t> vertexOrder;
  std::vector<std::uint32_t> faceOrder;
  /// Only if points were to be renumbered and were: the payload is for points of which number j is
  /// pointOrder[j] of the input. Only points at the same place change.
  std::vector<std::uint32_t> pointOrder;
  /// What a decoder returns.
  MeshCells decoded;
};

/// Codes cells. Without keepOrder, cells come back in an order of the coder's, faces from any of
/// their vertices on but in the same sense, vertex cells with their points sorted.
///
/// Throws Error(InvalidArgument) if a cell has a point that there is not, Error(Unsupported) for
/// more than 2^32 − 16 points or corners.
///
/// `surface`: the regular faces of prepareFaces() as a decoder knows them already, from the points
/// on; null if it does not.
EncodedMesh encodeMesh(const MeshPoints& points, const MeshCells& cells, const CodingWishes& wishes,
                       const Cells* surface = nullptr);

/// The cells. Any bytes are safe; `maxBytes` bounds the memory of the output and of all that is
/// allocated on the way. Throws Error(Corrupt, Unsupported, LimitExceeded).
///
/// `surface` is called with bytes of memory, for the faces that are known from the points on; null
/// if there can be none. `working` is called from time to time with how many cells are done; it may
/// throw to stop.
MeshCells decodeMesh(const MeshPoints& points, ByteView payload, std::uint64_t maxBytes,
                     const std::function<Cells(std::uint64_t)>& surface = nullptr,
                     const std::function<void(std::uint64_t)>& working = nullptr);

}  // namespace bspc::connectivity
