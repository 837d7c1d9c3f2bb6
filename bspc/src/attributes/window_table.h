#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// For each point of a sequence the nearest three of the 16 before it, by the sum of the absolute
/// differences of coordinates: the quick methods' neighbours, found without a search.
class WindowTable {
 public:
  static constexpr std::uint32_t kWindow = 16;
  static constexpr unsigned kNeighbours = 3;

  explicit WindowTable(Span<const GridPoint> points);

  /// How many places before point i its neighbours stand, nearest first, of equally near ones the
  /// later first; where there are fewer, the last one again. Point 0 has none: zeros.
  const std::array<std::uint8_t, kNeighbours + 1>& of(std::size_t i) const { return steps_[i]; }

  static std::uint64_t bytesFor(std::uint64_t points) { return points * (4 + 12); }

 private:
  std::vector<std::array<std::uint8_t, kNeighbours + 1>> steps_;
};

}  // namespace bspc::attributes
