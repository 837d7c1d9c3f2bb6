#pragma once

#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/point_set.h"
#include "cli/model_files.h"

namespace bspc::cli {

/// The points of a model file in memory, with the arrays and cells that are wanted of it.
class WholePoints {
 public:
  /// Reads to the end of the model, or the first `most` points alone, which then have no cells.
  explicit WholePoints(ModelPoints& points, std::uint64_t most = UINT64_MAX);

  /// Must not outlive this.
  PointSetView view() const;
  std::uint64_t size() const { return positions_.size() / (3 * scalarSize(type_)); }
  /// Whether the model has more points.
  bool isCut() const { return isCut_; }

 private:
  ScalarType type_;
  std::vector<std::uint8_t> positions_;
  std::vector<ArrayValues> values_;
  MeshCells mesh_;
  bool isCut_ = false;
};

}  // namespace bspc::cli
