#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "connectivity/vertex_index.h"
#include "entropy/adaptive_bit.h"

namespace bspc::connectivity {

/// Codes a vertex that is expected near a place, by its rank among the nearest ones of all.
class VertexPicker {
 public:
  VertexPicker(const VertexIndex& index, std::size_t vertices)
      : index_(index), last_(static_cast<std::uint32_t>(vertices - 1)) {}

  /// `place`: doubled coordinates.
  template <class Coder>
  std::uint32_t code(Coder& coder, const Position& place, std::uint32_t value) {
    index_.nearest(place, kRanks, VertexIndex::Among::All, nearest_);
    for (std::size_t i = 0; i < nearest_.size(); ++i) {
      if (coder.bit(isIt_[i], nearest_[i].vertex == value)) return nearest_[i].vertex;
    }
    return coder.uniform(value, last_);
  }

 private:
  static constexpr std::size_t kRanks = 32;

  const VertexIndex& index_;
  std::uint32_t last_;
  std::array<entropy::AdaptiveBit, kRanks> isIt_;
  std::vector<Neighbour> nearest_;
};

}  // namespace bspc::connectivity
