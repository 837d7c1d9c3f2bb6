#pragma once

#include <cstdint>

namespace bspc {

/// Bounds on what decoding a file may cost. Nothing is ever allocated on a file's word: output
/// grows as points are decoded, and the first bound that is reached ends it with
/// Error(LimitExceeded). Raise them for larger files, lower them for untrusted ones.
struct DecodeLimits {
  std::uint64_t points = std::uint64_t{1} << 33;
  std::uint64_t memoryBytes = std::uint64_t{16} << 30;  ///< of the decoder's own buffers and output
  std::uint64_t tiles = std::uint64_t{1} << 24;
  std::uint64_t arrays = 4096;
  /// Deepest level of a cell below the root of its tile.
  std::uint32_t depth = 512;
};

}  // namespace bspc
