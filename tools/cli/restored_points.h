#pragma once

#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/decoder.h"
#include "bspc/grid.h"
#include "bspc/point_set.h"

namespace bspc::cli {

/// Decoded points as coordinates of the type that went in, with their arrays, ready to be written
/// to a model file. Counts and cells are arrays "PointCount" and "CellId" behind the others.
class RestoredPoints {
 public:
  /// Views `points`, which must outlive this.
  RestoredPoints(const FileInfo& info, const DecodedPoints& points);
  PointSetView view() const;

 private:
  const DecodedPoints& points_;
  ScalarType type_;
  std::vector<std::uint8_t> coordinates_;
  std::vector<ArrayValues> numbers_;
};

/// What "PointCount" and "CellId" are in a file of so many points.
ArrayDescription countsDescription(std::uint64_t points);
ArrayDescription cellIdsDescription(std::uint64_t points);

}  // namespace bspc::cli
