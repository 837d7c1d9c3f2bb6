#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "box_filter.h"
#include "bspc/decoder.h"
#include "container/container_reader.h"

namespace bspc {

/// What a decoding takes from a file: which tiles, up to which level.
struct Query {
  std::vector<std::size_t> tiles;
  std::optional<BoxFilter> filter;
  std::vector<std::uint64_t> firstCells;  ///< of each of them, if cells are asked for
  unsigned level = 0;
  std::uint64_t points = 0;  ///< in the tiles up to the level
  bool complete = true;      ///< every point of the original is among them
  /// Those of the layout that are asked for, or have no name, and have values at the level.
  std::vector<std::size_t> arrays;
  bool inputOrder = false;  ///< points are put into the order of the input
  bool thin = false;        ///< even the coarsest level has more than maxPoints
};

/// Throws Error (InvalidArgument, Truncated) if the options ask for what is not there.
Query planQuery(const container::ContainerReader& file, const DecodeOptions& options);

/// Bytes of the file that decoding the query reads.
std::uint64_t bytesRead(const container::ContainerReader& file, const Query& query);

/// The level from which on every tile has values of arrays.
unsigned firstArrayLevel(const container::ContainerReader& file);

/// Points, or representatives, that a tile has up to a level.
std::uint64_t pointsUpTo(const container::TileRecord& tile, unsigned level);

/// Bytes of memory that the query gives for each point, texts of strings left out.
std::uint64_t bytesPerPoint(const container::ContainerReader& file, const Query& query,
                            const DecodeOptions& options);

/// Throws Error(LimitExceeded) if so many points are more than may be decoded: before anything is
/// allocated for them, since a few bytes can stand for very many.
void requireRoom(std::uint64_t points, std::uint64_t bytesPerPoint, std::uint64_t maxPoints,
                 std::uint64_t maxBytes);

}  // namespace bspc
