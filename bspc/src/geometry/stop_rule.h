#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "entropy/symbol_coder.h"
#include "geometry/geometry_method.h"

namespace bspc::geometry {

/// Where a lossy coding leaves cells undivided; stands in the stream.
struct StopRule {
  static constexpr unsigned kLevelBits = 10;
  static constexpr unsigned kMaxLevel = (1U << kLevelBits) - 1;

  std::uint32_t points = 0;       ///< cells of so many points or fewer
  std::optional<unsigned> level;  ///< cells of this level

  static StopRule of(const CodingWishes& wishes) {
    StopRule rule;
    constexpr std::uint64_t kAll = std::numeric_limits<std::uint32_t>::max();
    rule.points = static_cast<std::uint32_t>(wishes.stopPoints < kAll ? wishes.stopPoints : kAll);
    if (wishes.stopLevel && *wishes.stopLevel <= kMaxLevel) rule.level = wishes.stopLevel;
    return rule;
  }

  bool lossy() const { return points > 0 || level.has_value(); }
  bool stops(std::uint64_t count, unsigned atLevel) const {
    return count <= points || (level && atLevel >= *level);
  }

  template <class Coder>
  void code(Coder& coder) {
    if (coder.raw(points > 0 ? 1 : 0, 1) != 0) {
      points = static_cast<std::uint32_t>(coder.wide(points, 32));
    }
    if (coder.raw(level ? 1 : 0, 1) != 0) level = coder.raw(level.value_or(0), kLevelBits);
  }
};

}  // namespace bspc::geometry
