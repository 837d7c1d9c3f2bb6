#include "grid/step_interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>

#include "grid/lattice.h"

namespace bspc::lattice {

namespace {

/// Covers the rounding of the bounds themselves.
constexpr double kSlack = 4 * std::numeric_limits<double>::epsilon();

/// Narrows a step interval by distances that must be multiples of the step.
class Narrowing {
 public:
  Narrowing(const StepInterval& start, double noise) : interval_(start), noise_(noise) {}

  const StepInterval& interval() const { return interval_; }

  /// False if no step of the interval fits. A distance that several multiples fit says nothing.
  bool take(double distance) {
    const double least = std::max(1.0, std::ceil((distance - noise_) / interval_.high));
    const double most = std::floor((distance + noise_) / interval_.low);
    if (least > most) return false;
    if (least < most) return true;
    interval_.low = std::max(interval_.low, (distance - noise_) / least * (1 - kSlack));
    interval_.high = std::min(interval_.high, (distance + noise_) / least * (1 + kSlack));
    return !interval_.empty();
  }

  /// Whether the multiple at this distance is beyond doubt.
  bool settled(double distance) const {
    return distance / interval_.low - distance / interval_.high < 0.5;
  }

 private:
  StepInterval interval_;
  double noise_;
};

/// Takes neighbours' gaps from small to large, then differences over growing stretches, which
/// sharpen the step in proportion to their length.
std::optional<StepInterval> narrow(const std::vector<double>& values,
                                   const std::vector<double>& gaps, const StepInterval& start,
                                   double noise) {
  Narrowing narrowing(start, 2 * noise);
  for (const double gap : gaps) {
    if (!narrowing.take(gap)) return std::nullopt;
  }
  for (unsigned round = 0; round < 2; ++round) {
    for (std::size_t stretch = 2; stretch < values.size(); stretch *= 2) {
      for (std::size_t i = stretch; i < values.size(); ++i) {
        if (!narrowing.take(values[i] - values[i - stretch])) return std::nullopt;
      }
    }
  }
  const double whole = values.back() - values.front();
  if (!narrowing.take(whole) || !narrowing.settled(whole)) return std::nullopt;
  return narrowing.interval();
}

/// Euclid's algorithm on gaps with noise; an empty interval where noise hides the divisor.
StepInterval noisyDivisor(const std::vector<double>& gaps, double noise, double finest) {
  constexpr std::size_t kGaps = 256;
  double divisor = gaps.front();
  double error = 2 * noise;
  for (std::size_t i = 1; i < std::min(kGaps, gaps.size()); ++i) {
    double a = gaps[i];
    double aError = 2 * noise;
    while (true) {
      const double quotient = std::floor(a / divisor + 0.5);
      const double rest = std::fabs(a - quotient * divisor);
      const double restError = aError + quotient * error;
      if (restError > divisor / 4) return {1, 0};
      if (rest <= restError) break;
      a = divisor;
      aError = error;
      divisor = rest;
      error = restError;
      if (divisor < finest) return {1, 0};
    }
  }
  return {divisor - error, divisor + error};
}

double rounded(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, value);
  return std::strtod(text.data(), nullptr);
}

}  // namespace

double roundingNoise(ScalarType type, double value, double largest) {
  const double rounding = std::ldexp(1, spacingExponent(ScalarType::Float64, largest));
  return (std::ldexp(1, spacingExponent(type, value)) + rounding) / 2;
}

std::vector<StepInterval> stepsOfSample(const std::vector<double>& values, double noise,
                                        double finest) {
  constexpr unsigned kMaxDivisor = 16;
  constexpr std::size_t kMaxSteps = 4;
  std::vector<StepInterval> steps;
  if (values.size() < 3 || !std::isfinite(values.back() - values.front())) return steps;
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) gaps.push_back(values[i] - values[i - 1]);
  std::sort(gaps.begin(), gaps.end());
  // Different points of the lattice are a step apart, so a smaller gap proves there is none.
  const double least = gaps.front();
  if (least + 2 * noise < finest) return steps;
  std::vector<StepInterval> starts;
  for (unsigned divisor = 1; divisor <= kMaxDivisor; ++divisor) {
    starts.push_back({(least - 2 * noise) / divisor, (least + 2 * noise) / divisor});
  }
  starts.push_back(noisyDivisor(gaps, noise, finest));
  for (StepInterval start : starts) {
    start.low = std::max(start.low, finest);
    if (start.empty() || start.low <= 0) continue;
    if (const auto found = narrow(values, gaps, start, noise)) steps.push_back(*found);
    if (steps.size() == kMaxSteps) break;
  }
  return steps;
}

double shortDecimal(const StepInterval& interval) {
  for (int digits = 1; digits <= 6; ++digits) {
    const double decimal = rounded(interval.middle(), digits);
    if (interval.contains(decimal)) return decimal;
  }
  return 0;
}

std::vector<double> stepCandidates(const StepInterval& interval) {
  constexpr unsigned kNeighbours = 4;
  std::vector<double> candidates;
  const auto add = [&candidates](double step) {
    const bool known = std::find(candidates.begin(), candidates.end(), step) != candidates.end();
    if (step > 0 && std::isfinite(step) && !known) candidates.push_back(step);
  };
  const double middle = interval.middle();
  add(shortDecimal(interval));
  const double single{nearestFloat(middle)};
  if (interval.contains(single)) add(single);
  add(middle);
  double below = middle;
  double above = middle;
  for (unsigned i = 0; i < kNeighbours; ++i) {
    below = std::nextafter(below, 0);
    above = std::nextafter(above, std::numeric_limits<double>::infinity());
    add(below);
    add(above);
  }
  return candidates;
}

}  // namespace bspc::lattice
