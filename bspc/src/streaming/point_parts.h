#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bspc/grid.h"
#include "bspc/stream_encoder.h"
#include "tiling/cell_code.h"
#include "tiling/cell_groups.h"

namespace bspc::streaming {

/// Cuts more grid points than fit into memory into parts that do. Points are shown twice: first to
/// be counted, then to be stored, each part in blocks of its own in one scratch storage.
class PointParts {
 public:
  /// `box` holds all points.
  PointParts(const tiling::DyadicBox& box, std::uint64_t partPoints);

  void count(Span<const GridPoint> points);
  /// Ends the counting. `bufferBytes` is what may wait in memory to be stored.
  void cut(std::unique_ptr<ScratchStorage> storage, std::uint64_t bufferBytes);
  void store(Span<const GridPoint> points);
  /// Ends the storing.
  void flush();

  std::size_t parts() const { return parts_.size(); }
  /// Points of a part; more than partPoints only where a single cell has more.
  std::uint64_t size(std::size_t part) const { return parts_[part].points; }
  /// Points first … first + count − 1 of a part, in the order in which they were stored.
  std::vector<GridPoint> load(std::size_t part, std::uint64_t first, std::uint64_t count) const;

 private:
  struct Part {
    std::uint64_t points = 0;
    std::vector<GridPoint> waiting;
    std::vector<std::uint64_t> blocks;  ///< offsets in the storage; all full but the last
  };

  void write(Part& part);

  tiling::CellCode code_;
  std::uint64_t partPoints_;
  std::vector<std::uint64_t> counts_;  ///< by code of the cell
  tiling::CellGroups groups_;
  std::vector<Part> parts_;
  std::unique_ptr<ScratchStorage> storage_;
  std::size_t blockPoints_ = 0;
};

}  // namespace bspc::streaming
