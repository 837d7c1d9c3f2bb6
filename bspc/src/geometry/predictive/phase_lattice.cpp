#include "geometry/predictive/phase_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/predictive/periodogram.h"

namespace bspc::geometry::predictive {

namespace {

constexpr std::size_t kWindow = 400;  ///< distinct values that a period is sought in
constexpr std::size_t kLeastWindow = 24;
constexpr std::size_t kLeastValues = 32;
constexpr double kLowest = 0.012;

/// The distinct values of an axis, rising.
std::vector<std::uint32_t> distinctValues(Span<const GridPoint> points, unsigned axis) {
  std::uint32_t low = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t high = 0;
  for (const GridPoint& p : points) {
    low = std::min(low, p[axis]);
    high = std::max(high, p[axis]);
  }
  std::vector<std::uint32_t> values;
  if (points.empty()) return values;
  const std::uint64_t span = std::uint64_t{high} - low + 1;
  if (span / 16 <= points.size()) {
    std::vector<bool> seen(static_cast<std::size_t>(span));
    for (const GridPoint& p : points) seen[p[axis] - low] = true;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i]) values.push_back(low + static_cast<std::uint32_t>(i));
    }
    return values;
  }
  values.reserve(points.size());
  for (const GridPoint& p : points) values.push_back(p[axis]);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Sharpens on windows around `middle` that double until they hold everything.
double sharpenByDoubling(const std::vector<std::uint32_t>& values, std::uint32_t middle,
                         double frequency, double reach) {
  const double whole = static_cast<double>(values.back() - values.front()) + 1;
  for (;;) {
    const auto r = static_cast<std::uint32_t>(std::min(reach, 4294967295.0));
    const std::uint32_t from = middle > r ? middle - r : 0;
    const std::uint64_t to = std::uint64_t{middle} + r;
    const auto begin = std::lower_bound(values.begin(), values.end(), from);
    const auto end = std::upper_bound(begin, values.end(), to);
    const Span<const std::uint32_t> part(values.data() + (begin - values.begin()),
                                         static_cast<std::size_t>(end - begin));
    frequency = sharpenedFrequency(part, frequency, reach);
    if (part.size() == values.size()) return frequency;
    reach = std::min(2 * reach, whole);
  }
}

/// Whether knowing the phases is worth more than telling the frequency and learning them.
bool paysOff(Span<const GridPoint> points, unsigned axis, std::uint32_t frequency) {
  std::array<std::uint64_t, std::size_t{1} << kPhaseBits> counts{};
  for (const GridPoint& p : points) ++counts[phaseOf(p[axis], frequency)];
  const auto total = static_cast<double>(points.size());
  double entropy = 0;
  for (const std::uint64_t count : counts) {
    if (count == 0) continue;
    const double share = static_cast<double>(count) / total;
    entropy -= share * std::log2(share);
  }
  const double gain = kPhaseBits - entropy;
  constexpr double kLeastGain = 0.25;  // bits a point
  constexpr double kLeastTotal = 200;  // bits in all, a tenth a point aside
  return gain >= kLeastGain && (gain - 0.1) * total >= kLeastTotal;
}

}  // namespace

PhaseHistogram::PhaseHistogram(std::uint32_t frequency) : frequency_(frequency), maxLevel_(0) {
  bins_.fill(kFirstWeight);
  if (frequency == 0) return;
  // Two periods: 2^maxLevel · frequency ≥ 2 · 2^32, a frequency beyond 1/2 standing for its mirror.
  const std::uint32_t folded = std::min(frequency, 0U - frequency);
  constexpr unsigned kMostLevels = 7;
  maxLevel_ = 1;
  while (maxLevel_ < kMostLevels &&
         (std::uint64_t{folded} << maxLevel_) < (std::uint64_t{1} << 33)) {
    ++maxLevel_;
  }
}

void PhaseHistogram::add(std::uint32_t value) {
  std::uint32_t& bin = bins_[phaseOf(value, frequency_)];
  bin += kStep;
  if (bin < kMaxWeight) return;
  for (std::uint32_t& b : bins_) b /= 2;
}

PhaseHistogram::Sides PhaseHistogram::sides(std::uint32_t low, unsigned level) const {
  const std::uint32_t half = 1U << (level - 1);
  Sides s;
  std::uint32_t phase = low * frequency_;
  for (std::uint32_t i = 0; i < half; ++i, phase += frequency_) {
    s.lower += bins_[phase >> (32 - kPhaseBits)];
  }
  for (std::uint32_t i = 0; i < half; ++i, phase += frequency_) {
    s.upper += bins_[phase >> (32 - kPhaseBits)];
  }
  return s;
}

std::uint32_t findPhaseFrequency(Span<const GridPoint> points, unsigned axis) {
  const std::vector<std::uint32_t> values = distinctValues(points, axis);
  if (values.size() < kLeastValues) return 0;
  std::size_t size = std::min(values.size(), kWindow);
  std::size_t first = densestWindow(values, size);
  const auto span = [&] { return values[first + size - 1] - values[first]; };
  while (span() > Periodogram::kMaxSpan / 2 && size > kLeastWindow) {
    size /= 2;
    first = densestWindow(values, size);
  }
  if (span() > Periodogram::kMaxSpan) return 0;
  const double width = static_cast<double>(span()) + 1;
  constexpr double kDense = 0.8;  // nearly every value occurs: nothing to learn
  if (static_cast<double>(size) / width > kDense) return 0;

  Periodogram periodogram;
  const auto peak =
      periodogram.peak(Span<const std::uint32_t>(values.data() + first, size), kLowest);
  // Random values reach about 3.5 / √size somewhere.
  const double threshold = std::max(0.25, 4.5 / std::sqrt(static_cast<double>(size)));
  if (!peak || peak->coherence < threshold) return 0;
  const double frequency = sharpenByDoubling(values, values[first], peak->frequency, width);
  const auto cells = static_cast<std::uint32_t>(std::llround(frequency * kFrequencyUnit));
  return cells != 0 && paysOff(points, axis, cells) ? cells : 0;
}

}  // namespace bspc::geometry::predictive
