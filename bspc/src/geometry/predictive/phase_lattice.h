#pragma once

#include <array>
#include <cstdint>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::geometry::predictive {

/// Where values stand within the cells of a lattice that is finer than, or not aligned with, the
/// grid: scanner steps, an earlier quantisation. `frequency` is cells a grid step, in 2^-32.
constexpr unsigned kPhaseBits = 6;

constexpr unsigned phaseOf(std::uint32_t value, std::uint32_t frequency) {
  return (value * frequency) >> (32 - kPhaseBits);
}

/// The phases seen so far along an axis, learned as points become known. Integers only: encoder
/// and decoder repeat it.
class PhaseHistogram {
 public:
  PhaseHistogram() : PhaseHistogram(0) {}
  /// With frequency 0 the axis has no lattice, and the histogram knows nothing.
  explicit PhaseHistogram(std::uint32_t frequency);

  bool isActive() const { return frequency_ != 0; }
  std::uint32_t frequency() const { return frequency_; }

  /// Boxes of more than 2^maxLevel() steps cover whole periods on both sides and tell nothing.
  unsigned maxLevel() const { return maxLevel_; }

  void add(std::uint32_t value);

  std::uint32_t weight(std::uint32_t value) const { return bins_[phaseOf(value, frequency_)]; }

  struct Sides {
    std::uint32_t lower = 0;
    std::uint32_t upper = 0;
  };
  /// The weights of the halves of the box that begins at `low` and is 2^level steps wide, where
  /// 1 ≤ level ≤ maxLevel().
  Sides sides(std::uint32_t low, unsigned level) const;

 private:
  static constexpr std::uint32_t kFirstWeight = 8;
  static constexpr std::uint32_t kStep = 32;
  static constexpr std::uint32_t kMaxWeight = 1U << 24;  ///< 64 of them stay below 2^32

  std::uint32_t frequency_;
  unsigned maxLevel_;
  std::array<std::uint32_t, std::size_t{1} << kPhaseBits> bins_{};
};

/// One histogram an axis.
using PhaseHistograms = std::array<PhaseHistogram, 3>;

/// The encoder's search: the frequency of the lattice that the coordinates along `axis` lie near,
/// or 0 where none would pay. Takes about a tenth of a microsecond a point.
std::uint32_t findPhaseFrequency(Span<const GridPoint> points, unsigned axis);

}  // namespace bspc::geometry::predictive
