#pragma once

#include <cstdint>
#include <functional>

#include "bspc/decoder.h"
#include "container/container_reader.h"

namespace bspc {

/// Reads the cells of a file and their arrays into `points`, which has all points of the file in
/// the order in which they are returned. `memory` bounds what is allocated. Throws Error (Corrupt,
/// Unsupported, LimitExceeded, Io).
///
/// `working` is called from time to time with about the share of the cells that are done; it may
/// throw to stop.
void decodeMesh(const container::ContainerReader& file, std::uint64_t memory,
                const std::function<void(double share)>& working, DecodedPoints& points);

}  // namespace bspc
