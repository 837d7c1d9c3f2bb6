#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "bspc/io.h"

namespace bspc {

struct JoinOptions {
  Layout layout = Layout::Progressive;
  DecodeLimits limits;
  ProgressCallback progress;
};

/// What was written.
struct JoinReport {
  Grid grid;
  std::uint64_t points = 0;
  std::uint64_t tiles = 0;
  unsigned layers = 1;
  std::uint64_t fileBytes = 0;
  /// Entries and field arrays of later files that say something else than an earlier file's of the
  /// same name, whose are kept: "file 2: title".
  std::vector<std::string> droppedMetadata;
};

/// Writes one file with the tiles of several, which are copied without decoding; every checksum is
/// verified on the way. The files must share one lattice and scalar type (encode the others with
/// GridRequest::onGrid of the first). Where they differ in layers, the file has those of the finest
/// and the tiles of the others begin at a finer level. They must have the same arrays, by name, in
/// any order; of metadata the file has what they say together. It keeps the order of the input if
/// all of them do: tile after tile, file after file. Only one chunk is in memory at a time.
///
/// Throws Error: InvalidArgument names the first file (counted from 0) whose grid, arrays, unit or
/// coordinate reference system differ, and how, or for want of files; OutOfGrid if the joined
/// extent needs more than 32 bits; and what Decoder throws.
JoinReport join(const std::vector<std::shared_ptr<ByteSource>>& files, ByteSink& sink,
                const JoinOptions& options = {});

}  // namespace bspc
