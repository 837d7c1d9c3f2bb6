#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// The points of a tile as the coders of its arrays see them: the known ones first, whose tuples
/// were coded before (by coarser layers), then the new ones, in decoded order. Coder and decoder
/// make it from the same positions. It finds neighbours when the first array asks for them, and
/// keeps them for the others; so it serves one thread at a time.
class TilePoints {
 public:
  /// Views `points`, which must outlive this and are relative to the tile's lower corner.
  explicit TilePoints(Span<const GridPoint> points, std::size_t known = 0);

  /// Makes methods possible that follow the order of the input: order[j] is the input index of
  /// point known + j, or anything that sorts like it. Views `order`; no two may be equal.
  void setInputOrder(Span<const std::uint32_t> order);

  std::size_t size() const { return points_.size(); }
  std::size_t known() const { return known_; }
  std::size_t added() const { return points_.size() - known_; }
  bool hasInputOrder() const { return !inputOrder_.empty(); }

 private:
  Span<const GridPoint> points_;
  std::size_t known_;
  Span<const std::uint32_t> inputOrder_;
};

}  // namespace bspc::attributes
