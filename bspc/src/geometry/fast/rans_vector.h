#pragma once

#include <cstddef>
#include <cstdint>

namespace bspc::geometry::fast {

/// Eight lanes of a stream, as RansReader has them.
struct RansLanes {
  std::uint32_t states[8];
  const std::uint8_t* at;
};

/// Whether this machine can decode eight symbols at once.
bool hasVectorRans();

/// Decodes count / 8 times eight symbols by the entries of a DecodingTable, and returns the
/// greatest; only if hasVectorRans(). Reads up to 16 bytes past what it uses.
unsigned vectorRun(const std::uint32_t* entries, std::size_t count, RansLanes& lanes,
                   std::uint8_t* symbols);

}  // namespace bspc::geometry::fast
