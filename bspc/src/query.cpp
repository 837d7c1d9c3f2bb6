#include "query.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "arrays/tile_array_decoder.h"
#include "bspc/error.h"
#include "saturating.h"

namespace bspc {

namespace {

unsigned finestLevel(const container::ContainerReader& file, const DecodeOptions& options) {
  const unsigned layers = file.head().layers;
  if (options.level && *options.level >= layers) {
    throw Error(ErrorCode::InvalidArgument, "level " + std::to_string(*options.level) +
                                                " was asked for; the file has levels 0 to " +
                                                std::to_string(layers - 1));
  }
  if (options.level && *options.level >= file.wholeLayers()) {
    throw Error(ErrorCode::Truncated,
                "level " + std::to_string(*options.level) +
                    " was asked for, and the file was cut short after level " +
                    std::to_string(file.wholeLayers() - 1));
  }
  return options.level.value_or(std::max(file.wholeLayers(), 1U) - 1);
}

/// The tiles that may be read at all.
TileRange tileRange(const container::ContainerReader& file, const DecodeOptions& options) {
  const std::uint64_t all = file.tiles().size();
  if (!options.tiles) return {0, all};
  if (options.tiles->first > all || options.tiles->count > all - options.tiles->first) {
    throw Error(ErrorCode::InvalidArgument,
                std::to_string(options.tiles->count) + " tiles from number " +
                    std::to_string(options.tiles->first) + " on were asked for; the file has " +
                    std::to_string(all));
  }
  return *options.tiles;
}

std::uint64_t pointsOf(const container::ContainerReader& file,
                       const std::vector<std::size_t>& tiles, unsigned level) {
  std::uint64_t points = 0;
  for (const std::size_t i : tiles) {
    points = saturatingAdd(points, pointsUpTo(file.tiles()[i], level));
  }
  return points;
}

/// Indices in the layout of the arrays that the options ask for, and of those without a name.
std::vector<std::size_t> chosenArrays(const container::ContainerReader& file,
                                      const DecodeOptions& options) {
  const std::vector<ArrayDescription>& all = file.head().arrays;
  const std::size_t hidden = file.head().hiddenArrays();
  std::vector<std::size_t> chosen(hidden);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (options.arrays) {
    for (const std::string& name : *options.arrays) {
      const bool known = std::any_of(all.begin(), all.end(),
                                     [&name](const ArrayDescription& a) { return a.name == name; });
      if (known) continue;
      std::string names;
      for (const ArrayDescription& a : all) names += (names.empty() ? "" : ", ") + a.name;
      throw Error(ErrorCode::InvalidArgument,
                  "the file has no array \"" + name + "\"; " +
                      (names.empty() ? "it has none" : "it has " + names));
    }
  }
  for (std::size_t a = 0; a < all.size(); ++a) {
    if (!options.arrays || std::find(options.arrays->begin(), options.arrays->end(), all[a].name) !=
                               options.arrays->end()) {
      chosen.push_back(hidden + a);
    }
  }
  return chosen;
}

}  // namespace

unsigned firstArrayLevel(const container::ContainerReader& file) {
  unsigned level = 0;
  for (const container::TileRecord& tile : file.tiles()) {
    level = std::max(level, tile.firstArrayLayer(file.head().layers));
  }
  return level;
}

std::uint64_t pointsUpTo(const container::TileRecord& tile, unsigned level) {
  return level < tile.coarse.size() ? tile.coarse[level].representatives : tile.points;
}

Query planQuery(const container::ContainerReader& file, const DecodeOptions& options) {
  Query query;
  query.level = finestLevel(file, options);
  if (options.box) query.filter.emplace(file.head().grid, *options.box);
  const TileRange range = tileRange(file, options);
  for (std::size_t i = range.first; i < range.first + range.count; ++i) {
    const container::TileRecord& tile = file.tiles()[i];
    GridPoint upper = tile.lower;
    for (std::size_t k = 0; k < 3; ++k) upper[k] += tile.extent[k];
    if (!query.filter || query.filter->touches(tile.lower, upper)) query.tiles.push_back(i);
  }
  query.points = pointsOf(file, query.tiles, query.level);
  while (options.maxPoints && query.level > 0 && query.points > *options.maxPoints) {
    query.points = pointsOf(file, query.tiles, --query.level);
  }
  query.thin = options.maxPoints && query.points > *options.maxPoints;
  if (options.cellLevel && *options.cellLevel > query.level) {
    throw Error(ErrorCode::InvalidArgument, "cells of level " + std::to_string(*options.cellLevel) +
                                                " were asked for, and only levels up to " +
                                                std::to_string(query.level) + " are decoded");
  }
  if (options.cellLevel) {
    std::uint64_t cells = 0;
    std::size_t next = 0;
    for (const std::size_t tile : query.tiles) {
      for (; next < tile; ++next) {
        cells = saturatingAdd(cells, pointsUpTo(file.tiles()[next], *options.cellLevel));
      }
      query.firstCells.push_back(cells);
    }
  }
  query.arrays = chosenArrays(file, options);
  if (query.level < firstArrayLevel(file)) query.arrays.clear();
  query.inputOrder = file.head().keepsOrder && query.level + 1 == file.head().layers;
  query.complete = query.level + 1 == file.head().layers && !file.tilesMissing() && !query.filter &&
                   !query.thin && range.count == file.tiles().size();
  return query;
}

std::uint64_t bytesRead(const container::ContainerReader& file, const Query& query) {
  std::uint64_t bytes = file.overheadBytes();
  for (const std::size_t i : query.tiles) {
    bytes = saturatingAdd(bytes, file.bytesOfRecord(i));
    for (unsigned l = 0; l <= query.level; ++l) {
      const std::size_t column = file.layout().column(l, container::kGeometryPart);
      bytes = saturatingAdd(bytes, file.bytesOfChunk(i, column));
    }
    bytes =
        saturatingAdd(bytes, bytesOfArrays(file, i, query.level, query.arrays, query.inputOrder));
  }
  return bytes;
}

std::uint64_t bytesPerPoint(const container::ContainerReader& file, const Query& query,
                            const DecodeOptions& options) {
  std::uint64_t bytes =
      sizeof(GridPoint) + (options.wantCounts ? 8U : 0U) + (options.cellLevel ? 8U : 0U);
  for (const std::size_t a : query.arrays) {
    const attributes::ArrayShape& shape = file.layout().arrays[a];
    bytes += shape.components * arrayValueSize(shape.type);
  }
  return bytes;
}

void requireRoom(std::uint64_t points, std::uint64_t bytesPerPoint, std::uint64_t maxPoints,
                 std::uint64_t maxBytes) {
  if (points > maxPoints) {
    throw Error(ErrorCode::LimitExceeded, "the file says that it holds " + std::to_string(points) +
                                              " points, more than the limit of " +
                                              std::to_string(maxPoints) +
                                              "; raise the limit if the file is to be trusted");
  }
  if (points > maxBytes / bytesPerPoint) {
    throw Error(ErrorCode::LimitExceeded,
                "the file says that it holds " + std::to_string(points) +
                    " points, which need more memory than the limit of " +
                    std::to_string(maxBytes) +
                    " bytes; raise the limit if the file is to be trusted");
  }
}

}  // namespace bspc
