#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "bspc/span.h"

namespace bspc::geometry::predictive {

/// How well values lie on a lattice of `frequency` cells a step: 0 not at all, 1 exactly.
struct LatticePeak {
  double frequency = 0;
  double coherence = 0;  ///< |mean of exp(2πi · frequency · value)|
};

/// Finds periods of integers by the Fourier transform of the set that they are. For encoders:
/// floating point that no decoder repeats.
class Periodogram {
 public:
  Periodogram();
  ~Periodogram();
  Periodogram(const Periodogram&) = delete;
  Periodogram& operator=(const Periodogram&) = delete;

  /// The peak of distinct rising values among the frequencies from `lowest` to 1/2; of a lattice's
  /// harmonics the lowest. None if there are no frequencies to try. The values span at most
  /// kMaxSpan.
  std::optional<LatticePeak> peak(Span<const std::uint32_t> values, double lowest);

  static constexpr std::uint32_t kMaxSpan = 65535;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// A frequency of one cell a step, where frequencies are whole numbers.
constexpr double kFrequencyUnit = 4294967296.0;

/// The coherence of values with a frequency of `cells` / 2^32 a step; of many values only an even
/// choice of about `sample` is looked at.
double latticeCoherence(Span<const std::uint32_t> values, std::uint32_t cells, std::size_t sample);

/// Sharpens the frequency, in cells a step, of a lattice near values that span `reach` steps.
double sharpenedFrequency(Span<const std::uint32_t> values, double frequency, double reach);

/// The first of the `size` neighbouring values of a rising sequence that lie closest together.
std::size_t densestWindow(Span<const std::uint32_t> values, std::size_t size);

}  // namespace bspc::geometry::predictive
