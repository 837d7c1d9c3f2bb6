#include "geometry/predictive/periodogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace bspc::geometry::predictive {

namespace {

constexpr double kTurn = 6.283185307179586;

/// Cosines and sines of the phases that a circle is divided into.
class Circle {
 public:
  static constexpr unsigned kBits = 12;

  Circle() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double angle =
          kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(points_.size());
      points_[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
  }

  /// The point at `phase` / 2^32 of a turn.
  const std::array<float, 2>& at(std::uint32_t phase) const {
    return points_[phase >> (32 - kBits)];
  }

 private:
  std::array<std::array<float, 2>, std::size_t{1} << kBits> points_{};
};

std::uint32_t cellsOf(double frequency) {
  return static_cast<std::uint32_t>(std::llround(frequency * kFrequencyUnit));
}

constexpr std::size_t kSample = 3000;  ///< values that a frequency is sharpened on

}  // namespace

struct Periodogram::Workspace {
  Eigen::FFT<float> fft;
  std::vector<float> indicator;
  std::vector<std::complex<float>> spectrum;
  std::vector<float> coherence;
};

Periodogram::Periodogram() : workspace_(std::make_unique<Workspace>()) {
  workspace_->fft.SetFlag(Eigen::FFT<float>::HalfSpectrum);
}

Periodogram::~Periodogram() = default;

std::optional<LatticePeak> Periodogram::peak(Span<const std::uint32_t> values, double lowest) {
  if (values.size() < 2) return std::nullopt;
  const std::uint32_t first = values[0];
  const std::uint32_t span = values[values.size() - 1] - first;
  if (span > kMaxSpan) return std::nullopt;
  // Four frequencies a lobe, so that no peak falls between two of them.
  std::size_t size = 64;
  while (size < 4 * (std::size_t{span} + 1)) size *= 2;
  std::vector<float>& indicator = workspace_->indicator;
  indicator.assign(size, 0.0F);
  for (const std::uint32_t v : values) indicator[v - first] = 1;
  workspace_->fft.fwd(workspace_->spectrum, indicator);

  std::vector<float>& coherence = workspace_->coherence;
  coherence.resize(size / 2 + 1);
  for (std::size_t i = 0; i < coherence.size(); ++i) {
    coherence[i] = std::abs(workspace_->spectrum[i]) / static_cast<float>(values.size());
  }
  // Below four periods in the window a peak cannot be told from the mean's own lobe.
  const double bins = static_cast<double>(size);
  const double least = std::max(lowest, 4.0 / (static_cast<double>(span) + 1));
  const auto begin = static_cast<std::size_t>(std::ceil(least * bins));
  if (begin >= coherence.size()) return std::nullopt;
  const float top =
      *std::max_element(coherence.begin() + static_cast<std::ptrdiff_t>(begin), coherence.end());
  constexpr float kNearlyTop = 0.9F;
  std::size_t best = begin;
  while (coherence[best] < kNearlyTop * top) ++best;
  while (best + 1 < coherence.size() && coherence[best + 1] > coherence[best]) ++best;
  return LatticePeak{static_cast<double>(best) / bins, coherence[best]};
}

double latticeCoherence(Span<const std::uint32_t> values, std::uint32_t cells, std::size_t sample) {
  static const Circle circle;
  const std::size_t stride = std::max<std::size_t>(1, values.size() / sample);
  double x = 0;
  double y = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); i += stride, ++count) {
    const std::array<float, 2>& p = circle.at(values[i] * cells);
    x += p[0];
    y += p[1];
  }
  return count == 0 ? 0 : std::sqrt(x * x + y * y) / static_cast<double>(count);
}

double sharpenedFrequency(Span<const std::uint32_t> values, double frequency, double reach) {
  const double centre = frequency;
  double best = 0;
  const auto consider = [&](double f) {
    const double c = latticeCoherence(values, cellsOf(f), kSample);
    if (c <= best) return false;
    best = c;
    frequency = f;
    return true;
  };
  const double step = 0.05 / reach;
  for (int i = -12; i <= 12; ++i) consider(centre + i * step);
  constexpr int kHalvings = 9;
  for (int i = 1; i <= kHalvings; ++i) {
    const double s = std::ldexp(step, -i);
    if (!consider(frequency + s)) consider(frequency - s);
  }
  return frequency;
}

std::size_t densestWindow(Span<const std::uint32_t> values, std::size_t size) {
  std::size_t best = 0;
  for (std::size_t i = 0; i + size <= values.size(); ++i) {
    if (values[i + size - 1] - values[i] < values[best + size - 1] - values[best]) best = i;
  }
  return best;
}

}  // namespace bspc::geometry::predictive
