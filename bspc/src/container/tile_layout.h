#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/array_coder.h"

namespace bspc::container {

/// What a chunk of a tile holds: the geometry of a layer, the order of the points, or (from
/// kFirstArrayPart on) the values of an array in a layer.
constexpr std::size_t kGeometryPart = 0;
constexpr std::size_t kOrderPart = 1;
constexpr std::size_t kFirstArrayPart = 2;

/// What the tiles of a file are made of. Chunks stand in columns: layer after layer, and in each
/// part after part. A tile need not have a chunk in every column.
struct TileLayout {
  unsigned layers = 1;
  /// Of the values that each point has beside its position on the grid.
  std::vector<attributes::ArrayShape> arrays;
  bool keepsOrder = false;

  /// Whether tile records have the fields about arrays and the order.
  bool hasArrayFields() const { return keepsOrder || !arrays.empty(); }
  std::size_t parts() const { return hasArrayFields() ? kFirstArrayPart + arrays.size() : 1; }
  std::size_t columns() const { return layers * parts(); }
  std::size_t column(unsigned layer, std::size_t part) const { return layer * parts() + part; }
  unsigned layerOf(std::size_t column) const { return static_cast<unsigned>(column / parts()); }
  std::size_t partOf(std::size_t column) const { return column % parts(); }
};

}  // namespace bspc::container
