#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/point_set.h"
#include "formats/output_buffer.h"
#include "formats/scalar_convert.h"

namespace bspc::formats {

/// Numbers of a point that become part of a record: a coordinate, or a component of an array.
struct RecordField {
  static constexpr std::size_t kPosition = SIZE_MAX;

  std::string name;
  std::size_t array = kPosition;
  std::size_t component = 0;
  /// The type in the record: that of the array, or Float64 for integers of 64 bits.
  ScalarType type = ScalarType::Float32;
  std::size_t offset = 0;
};

/// The numbers of an array's component; bits are those of UInt8.
ScalarSource componentOf(const ArrayView& array, std::size_t component);

/// The numbers of an axis.
ScalarSource coordinatesOf(const PointSetView& points, std::size_t axis);

/// Writes points as records of `recordBytes` bytes, little endian. Throws FormatError for an
/// integer that a double does not hold; `format` is who should hold it: "a PLY file".
void writeRecords(OutputBuffer& out, const PointSetView& points,
                  const std::vector<RecordField>& fields, std::size_t recordBytes,
                  const char* format);

/// Throws FormatError if an array is of strings, which `format` cannot hold.
void requireNumbers(const std::vector<ArrayDescription>& arrays, const char* format);

}  // namespace bspc::formats
