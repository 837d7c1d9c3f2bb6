#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/fast/tile_header.h"

namespace bspc::geometry::fast {

/// A point of the encoder, with where it came from.
struct TilePoint {
  GridPoint at;
  std::uint32_t index;
};

/// The points of a tile that are coded together: all of them, or some.
class SetPoints {
 public:
  explicit SetPoints(const RankedPoints& tile) : tile_(tile), size_(tile.size()) {}
  SetPoints(const RankedPoints& tile, std::vector<std::uint32_t> chosen)
      : tile_(tile), chosen_(std::move(chosen)), size_(chosen_.size()) {}

  std::size_t size() const { return size_; }
  TilePoint operator[](std::size_t i) const {
    const std::uint32_t index = chosen_.empty() ? static_cast<std::uint32_t>(i) : chosen_[i];
    return {tile_[index], index};
  }

 private:
  const RankedPoints& tile_;
  std::vector<std::uint32_t> chosen_;
  std::size_t size_;
};

}  // namespace bspc::geometry::fast
