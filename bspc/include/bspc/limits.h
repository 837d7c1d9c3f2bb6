#pragma once

#include <cstdint>

namespace bspc {

/// Bounds on what decoding a file may cost. Nothing is ever allocated on a file's word: what it
/// claims is checked before anything is done for it, output grows as points are decoded, and the
/// first bound that is reached ends it with Error(LimitExceeded). Raise them for larger files,
/// lower them for untrusted ones.
///
/// Whatever a file of S bytes says, opening and decoding it allocates at a time at most
///
///   memoryBytes + 4 S + 16 MiB
///
/// on one thread, and 2 memoryBytes + 4 S + 16 MiB a thread on several, where tiles wait for each
/// other. (The 16 MiB are tables of models and a window of zstd, whose size a file cannot choose.)
/// A file that claims N points is refused at once, with nothing allocated for them, if N is above
/// `points` or if N points take more than memoryBytes by themselves: 12 bytes each, 8 for a count,
/// 8 for a cell, and a tuple of every array. So is a tile of decodeTiles() by itself, and a mesh by
/// its cells, 4 bytes each. N points that are allowed cost memory only as they are decoded; equal
/// ones take hardly any bytes in a file, so a small file may use all that the limits allow.
///
/// The time is bounded by the bytes and by what they claim, not by the bytes alone: up to about
/// 0.2 µs a point with the methods fast, kd and gencode, 3 with octree, 13 with bsp, 43 with
/// predictive and 66 a face with surface; faces coded over known vertices take longer the more
/// vertices there are. docs/format.md, section 19, says why and how that is measured. Lower
/// `points`, or stop by the progress callback, which is called often (bspc/progress.h).
struct DecodeLimits {
  std::uint64_t points = std::uint64_t{1} << 33;
  std::uint64_t memoryBytes = std::uint64_t{16} << 30;  ///< of buffers, output and index
  std::uint64_t tiles = std::uint64_t{1} << 24;
  std::uint64_t arrays = 4096;
  /// Deepest level of a cell below the root of its tile.
  std::uint32_t depth = 512;
};

}  // namespace bspc
