#pragma once

#include <cstdint>

#include "bspc/error.h"
#include "geometry/fast/bit_stream.h"
#include "geometry/fast/cell.h"

namespace bspc::geometry::fast {

/// The tree of slabs, for encoder (Bits = BitWriter) and decoder (Bits = BitReader) alike.
///
/// `Slabs` knows the encoder's tree and takes the slabs in order:
///   Node                                        a node of the encoder's tree; empty in a decoder
///   bool isSlab(Node), unsigned heightAxis(Node), std::uint64_t countLower(Node)
///   Node child(Node, unsigned half)
///   void slab(Node, const Cell&, std::uint64_t points, unsigned heightAxis)
template <class Bits, class Slabs>
void codeSlabTree(Bits& bits, Slabs& slabs, const typename Slabs::Node& node, const Cell& cell,
                  std::uint64_t points, const StepScale& scale) {
  if (bits.code(slabs.isSlab(node) ? 1 : 0, 1) != 0) {
    const auto axis = static_cast<unsigned>(bits.code(slabs.heightAxis(node), 2));
    if (axis > 2) throw Error(ErrorCode::Corrupt, "a slab has no height axis");
    slabs.slab(node, cell, points, axis);
    return;
  }
  if (cell.isUnit()) throw Error(ErrorCode::Corrupt, "a cell of one grid position is split");
  const std::uint64_t lower = bits.code(slabs.countLower(node), entropy::bitLength(points));
  if (lower > points) throw Error(ErrorCode::Corrupt, "half of a cell has more points than it");
  const unsigned axis = cell.splitAxis(scale);
  if (lower > 0)
    codeSlabTree(bits, slabs, slabs.child(node, 0), cell.lowerHalf(axis), lower, scale);
  if (lower < points) {
    codeSlabTree(bits, slabs, slabs.child(node, 1), cell.upperHalf(axis), points - lower, scale);
  }
}

}  // namespace bspc::geometry::fast
