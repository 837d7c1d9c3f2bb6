#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "formats/input_buffer.h"
#include "formats/model.h"

namespace bspc::formats {

/// What stands in front of the points of a LAS file ("LAS Specification 1.4 - R15", Public Header
/// Block and Variable Length Records).
struct LasHeader {
  unsigned minorVersion = 0;
  unsigned pointFormat = 0;
  /// Bytes of a point record.
  std::size_t recordBytes = 0;
  std::uint64_t points = 0;
  /// A coordinate is X * scale + offset of a whole number X.
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  /// Extended records behind the points.
  std::uint64_t extendedRecords = 0;
  /// Whether the file is said to have waveforms behind the points.
  bool hasWaveforms = false;
  /// The descriptions of extra bytes, one behind the other.
  Bytes extraDescriptions;
  /// What the header and the records behind it say.
  Metadata metadata;
  /// What nothing of the above holds.
  std::vector<OtherContent> otherContent;
};

/// Reads up to the first point, where the input is left. Throws FormatError.
LasHeader readLasHeader(InputBuffer& in);

}  // namespace bspc::formats
