#pragma once

#include <cstdint>
#include <memory>
#include <ostream>

#include "bspc/point_set.h"
#include "bspc/progress.h"
#include "formats/model_io.h"
#include "formats/output_buffer.h"
#include "formats/point_writer.h"

namespace bspc::formats {

/// Writes a model to a stream piece by piece, so that memory stays bounded.
class ModelWriter {
 public:
  /// Writes what stands in front of the points. The stream, opened in binary mode, must outlive
  /// this. Throws FormatError if the format cannot hold such a model.
  ModelWriter(std::ostream& out, Format format, ModelLayout layout,
              const ProgressCallback& progress = {});

  /// Appends points, of the type and with the arrays of the layout. Throws FormatError,
  /// Error(Cancelled).
  void append(const PointSetView& piece);
  /// Throws FormatError if the stream fails, or if the points are not as many as the layout says.
  void finish();

  /// Greatest distance along an axis that the format has moved points by; only LAS, which rounds to
  /// its scale, does.
  double greatestError() const { return writer_->greatestError(); }

 private:
  ModelLayout layout_;
  OutputBuffer out_;
  std::unique_ptr<PointWriter> writer_;
  std::uint64_t written_ = 0;
};

}  // namespace bspc::formats
