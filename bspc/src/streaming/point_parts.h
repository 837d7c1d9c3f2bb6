#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bspc/grid.h"
#include "bspc/stream_encoder.h"
#include "tiling/cell_code.h"
#include "tiling/cell_groups.h"

namespace bspc::streaming {

/// Grid points with records of one length that belong to them.
struct PartPoints {
  std::vector<GridPoint> points;
  Bytes records;  ///< one after the other
};

/// Cuts more grid points than fit into memory into parts that do. Points are shown twice: first to
/// be counted, then to be stored, each part in blocks of its own in one scratch storage.
class PointParts {
 public:
  /// `box` holds all points.
  PointParts(const tiling::DyadicBox& box, std::uint64_t partPoints, std::size_t recordBytes);

  void count(Span<const GridPoint> points);
  /// Ends the counting. `bufferBytes` is what may wait in memory to be stored.
  void cut(std::unique_ptr<ScratchStorage> storage, std::uint64_t bufferBytes);
  /// The same, but all points stay in one part in the order in which they are stored, however many
  /// there are; nothing needs to be counted.
  void keepTogether(std::unique_ptr<ScratchStorage> storage);
  /// `records`: as many as points, one after the other.
  void store(Span<const GridPoint> points, ByteView records);
  /// Ends the storing.
  void flush();

  std::size_t parts() const { return parts_.size(); }
  /// Points of a part; more than partPoints only where a single cell has more, or all are kept
  /// together.
  std::uint64_t size(std::size_t part) const { return parts_[part].points; }
  /// Points first … first + count − 1 of a part, in the order in which they were stored.
  PartPoints load(std::size_t part, std::uint64_t first, std::uint64_t count) const;

 private:
  struct Part {
    std::uint64_t points = 0;           ///< counted, or stored if all are kept together
    Bytes waiting;                      ///< points with their records
    std::vector<std::uint64_t> blocks;  ///< offsets in the storage; all full but the last
  };

  void add(Part& part, const GridPoint& point, const std::uint8_t* record);
  void write(Part& part);

  tiling::CellCode code_;
  std::uint64_t partPoints_;
  std::size_t recordBytes_;
  std::size_t bytesPerPoint_;
  bool together_ = false;
  std::vector<std::uint64_t> counts_;  ///< by code of the cell
  tiling::CellGroups groups_;
  std::vector<Part> parts_;
  std::unique_ptr<ScratchStorage> storage_;
  std::size_t blockPoints_ = 0;
};

}  // namespace bspc::streaming
