#pragma once

#include "bspc/decoder.h"
#include "bspc/grid.h"
#include "formats/model_io.h"

namespace bspc::cli {

/// Decoded points as coordinates of the type that went in, ready to be written to a model file.
/// Views `points`, which must outlive it.
class RestoredPoints {
 public:
  RestoredPoints(const Grid& grid, const DecodedPoints& points);
  formats::ModelView model() const;

 private:
  const DecodedPoints& points_;
  ScalarType type_;
  std::vector<std::uint8_t> coordinates_;
};

}  // namespace bspc::cli
