#pragma once

#include <memory>

#include "bspc/point_set.h"
#include "formats/model.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// Writes a model in one format, piece by piece. Throws FormatError, also when it is made if the
/// format cannot hold such a model.
class PointWriter {
 public:
  PointWriter() = default;
  virtual ~PointWriter() = default;
  PointWriter(const PointWriter&) = delete;
  PointWriter& operator=(const PointWriter&) = delete;

  /// Writes what stands in front of the points.
  virtual void begin(OutputBuffer& out) = 0;
  /// Writes points, of the type and with the arrays of the layout.
  virtual void append(OutputBuffer& out, const PointSetView& points) = 0;
  /// Writes what stands behind the points.
  virtual void finish(OutputBuffer& /*out*/) {}
  /// Greatest distance along an axis that the format has moved points by.
  virtual double greatestError() const { return 0; }
};

}  // namespace bspc::formats
