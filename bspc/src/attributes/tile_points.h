#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "attributes/memory_budget.h"
#include "attributes/neighbours.h"
#include "attributes/window_table.h"
#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// The points of a tile as the coders of its arrays see them: the known ones first, whose tuples
/// were coded before (by coarser layers), then the new ones, in decoded order. Coder and decoder
/// make it from the same positions. It finds neighbours when the first array asks for them, and
/// keeps them for the others; so it serves one thread at a time.
class TilePoints {
 public:
  /// Views `points`, which must outlive this and are relative to the tile's lower corner; at most
  /// 2^32 − 1 points.
  explicit TilePoints(Span<const GridPoint> points, std::size_t known = 0);

  /// Makes methods possible that follow the order of the input: order[j] is the input index of
  /// point known + j, or anything that sorts like it. Throws Error(InvalidArgument) unless there
  /// are as many as new points, all different.
  void setInputOrder(Span<const std::uint32_t> order);

  std::size_t size() const { return points_.size(); }
  std::size_t known() const { return known_; }
  std::size_t added() const { return points_.size() - known_; }
  bool hasInputOrder() const { return !inputSequence_.empty(); }

  // For the coders. What is made for the first time is taken from `budget`.

  const RankedPoints& ranked(MemoryBudget& budget);
  /// At least the `limit` nearest neighbours: 8 in small cells, or 20 in larger ones.
  const NeighbourTable& neighbours(unsigned limit, MemoryBudget& budget);
  /// Of the new points among themselves, in decoded order.
  const WindowTable& window(MemoryBudget& budget);
  /// The new points in decoded order.
  Span<const std::uint32_t> decodedSequence(MemoryBudget& budget);
  /// The new points in the order of the input; empty if that is not known.
  Span<const std::uint32_t> inputSequence() const { return inputSequence_; }

 private:
  Span<const GridPoint> points_;
  std::size_t known_;
  std::vector<std::uint32_t> inputSequence_;
  std::vector<std::uint32_t> decodedSequence_;
  std::optional<RankedPoints> ranked_;
  std::optional<NeighbourTable> near_;
  std::optional<NeighbourTable> wide_;
  std::optional<WindowTable> window_;
};

}  // namespace bspc::attributes
