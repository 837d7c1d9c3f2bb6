#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "entropy/logistic_math.h"
#include "entropy/symbol_coder.h"
#include "geometry/predictive/question.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Predictor: which coordinates were used before along an axis, in dyadic intervals of up to 2^12
/// grid steps. Flat and stepped parts repeat coordinates all over a model.
class AxisValues {
 public:
  float evidence = 0;
  unsigned lowerClass = 0;
  unsigned upperClass = 0;

  /// `bits`: of the greatest coordinate, 0 … 32; `points`: of the tile.
  AxisValues(unsigned bits, std::uint32_t points)
      : bits_(bits), tableBits_(std::min(bits + 1, mostTableBits(points))) {
    for (auto& table : seen_) table.assign(std::size_t{1} << tableBits_, 0);
  }

  void add(const GridPoint& point) {
    const unsigned levels = std::min(bits_, kLevels);
    for (unsigned k = 0; k < 3; ++k) {
      for (unsigned open = 0; open <= levels; ++open) {
        std::uint16_t& seen = seen_[k][slot(open, point[k] >> open)];
        if (seen < 0xFFFF) ++seen;
      }
    }
  }

  void ask(const Question& q) {
    const std::uint32_t lower = q.value >> (q.open - 1);
    const unsigned below = seen_[q.axis][slot(q.open - 1, lower)];
    const unsigned above = seen_[q.axis][slot(q.open - 1, lower + 1)];
    evidence = entropy::naturalLog((static_cast<float>(above) + 0.3F) /
                                   (static_cast<float>(below) + 0.3F));
    lowerClass = countClass(below);
    upperClass = countClass(above);
  }

  static constexpr unsigned kClasses = 8;

 private:
  static constexpr unsigned kLevels = 12;

  /// Small grids give every interval a place of its own; intervals of larger ones share places,
  /// about 32 for each point.
  static unsigned mostTableBits(std::uint32_t points) {
    constexpr unsigned kLeast = 17;
    constexpr unsigned kMost = 21;
    const unsigned wished = entropy::bitLength(points) + 5;
    return std::clamp(wished, kLeast, kMost);
  }

  static constexpr unsigned kMany = 60;
  static constexpr std::array<std::uint8_t, kMany + 1> countClasses() {
    std::array<std::uint8_t, kMany + 1> classes{};
    for (unsigned n = 0; n <= kMany; ++n) {
      classes[n] = static_cast<std::uint8_t>(n < 3    ? n
                                             : n < 5  ? 3
                                             : n < 9  ? 4
                                             : n < 20 ? 5
                                             : n < 60 ? 6
                                                      : 7);
    }
    return classes;
  }
  /// From a table: branches on it would be foreseen badly.
  static unsigned countClass(unsigned n) {
    static constexpr auto kCountClasses = countClasses();
    return kCountClasses[std::min(n, kMany)];
  }

  std::size_t slot(unsigned open, std::uint32_t index) const {
    const std::uint64_t place = (std::uint64_t{1} << (bits_ - open)) + index;
    if (bits_ < tableBits_) return static_cast<std::size_t>(place);
    return static_cast<std::size_t>((place * 0x9E3779B97F4A7C15U) >> (64 - tableBits_));
  }

  unsigned bits_;
  unsigned tableBits_;
  std::array<std::vector<std::uint16_t>, 3> seen_;
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
