#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/input_buffer.h"

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
  /// Whether something is declared to follow the points, beside extended records.
  bool hasWaveforms = false;
  std::uint64_t extendedRecords = 0;
  /// What the points have beside positions, and what stands between header and points, as phrases
  /// for ModelInfo::otherContent.
  std::vector<std::string> otherContent;
};

/// Reads up to the first point, where the input is left. Throws FormatError.
LasHeader readLasHeader(InputBuffer& in);

}  // namespace bspc::formats
