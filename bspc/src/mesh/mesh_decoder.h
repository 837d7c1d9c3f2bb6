#pragma once

#include <cstdint>

#include "bspc/decoder.h"
#include "container/container_reader.h"

namespace bspc {

/// Reads the cells of a file and their arrays into `points`, which has all points of the file in
/// the order in which they are returned. `memory` bounds what is allocated. Throws Error (Corrupt,
/// Unsupported, LimitExceeded, Io).
void decodeMesh(const container::ContainerReader& file, std::uint64_t memory,
                DecodedPoints& points);

}  // namespace bspc
