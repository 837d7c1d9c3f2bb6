#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "entropy/logistic_mixer.h"
#include "geometry/surface/vertex_predictor.h"

namespace bspc::geometry::surface {

/// Codes where a vertex is, x, y, z in turn, given where it is expected: each coordinate by
/// halving the values that are left, outwards from the best guess, each half weighed by what all
/// guesses say of it. For encoder and decoder alike.
template <class Coder>
class CoordinateCoder {
 public:
  CoordinateCoder(Coder& coder, const GridPoint& extent)
      : coder_(coder),
        extent_(extent),
        mixer_({kSteps, kSituations * 3, kWidths}, {3}, kInputs, kWeight, kRate, kCounterAge),
        byWidth_(std::size_t{kSteps} * kWidths * kFractions),
        bySituation_(std::size_t{kSteps} * kSituations * kWidths),
        byExact_(std::size_t{kExact} * kStages * kRelations * VertexPrediction::kTrusts * 3) {}

  /// `place` is the truth for an encoder; a decoder's is ignored.
  GridPoint code(const VertexPrediction& prediction, const GridPoint& place) {
    prediction_ = &prediction;
    GridPoint coded{};
    for (axis_ = 0; axis_ < 3; ++axis_) {
      for (unsigned g = 0; g < kGuesses; ++g) aim(g, coded);
      coded[axis_] = static_cast<std::uint32_t>(codeCoordinate(place[axis_]));
    }
    return coded;
  }

 private:
  static constexpr unsigned kSteps = 24;  ///< the side, ten outwards each way, three of halving
  static constexpr unsigned kOutwards = 10;
  static constexpr unsigned kHalving = 21;
  static constexpr unsigned kStages = 10;
  static constexpr unsigned kWidths = 16;
  static constexpr unsigned kFractions = 3;
  static constexpr unsigned kRelations = 5;
  static constexpr unsigned kInputs = 24;
  static constexpr float kWeight = 0.13F;
  static constexpr float kBias = 0.3F;
  static constexpr unsigned kCounterAge = 250;
  static constexpr entropy::MixingRate kRate{0.02F, 200, 0.006F};
  static constexpr std::array<double, 2> kNarrowAndWide{0.4, 1.3};

  /// Where a guess expects the coordinate, given those before it.
  struct Aim {
    double mean = 0;
    double deviation = 1;
  };

  void aim(unsigned g, const GridPoint& coded) {
    constexpr double kLeastVariance = 0.1;
    constexpr double kSingular = 1e-6;
    const VertexPrediction::Guess& guess = prediction_->guesses[g];
    const std::array<Vector3, 3>& c = guess.spread;
    double mean = guess.place[axis_];
    double variance = c[axis_][axis_];
    const auto off = [&](unsigned k) { return static_cast<double>(coded[k]) - guess.place[k]; };
    if (axis_ == 1) {
      const double slope = c[1][0] / c[0][0];
      mean = mean + slope * off(0);
      variance = variance - slope * c[1][0];
    } else if (axis_ == 2) {
      const double whole = c[0][0] * c[1][1];
      double determinant = whole - c[0][1] * c[0][1];
      if (!(determinant > kSingular * whole)) determinant = kSingular * whole;
      const double x = (c[1][1] * c[2][0] - c[0][1] * c[2][1]) / determinant;
      const double y = (c[0][0] * c[2][1] - c[0][1] * c[2][0]) / determinant;
      mean = mean + (x * off(0) + y * off(1));
      variance = variance - (x * c[2][0] + y * c[2][1]);
    }
    aims_[g] = {mean, std::sqrt(variance > kLeastVariance ? variance : kLeastVariance)};
  }

  std::int64_t codeCoordinate(std::int64_t value) {
    low_ = 0;
    high_ = extent_[axis_];
    const Aim& best = aims_[VertexPrediction::kBest];
    const double last = static_cast<double>(high_);
    const double mean = best.mean > 0 ? (best.mean < last ? best.mean : last) : 0;
    const double middle = std::floor(mean + 0.5);
    const auto start = std::min(static_cast<std::int64_t>(middle), high_);
    const auto fraction = static_cast<float>(mean - middle + 0.5);
    fraction_ = entropy::classOf(fraction, 3, 0, kFractions);
    const auto deviation = static_cast<float>(best.deviation);
    width_ = static_cast<unsigned>(
        std::clamp(entropy::halfOctave(deviation) + 4, 0, static_cast<int>(kWidths) - 1));
    std::int64_t unit = 1;
    while (static_cast<double>(2 * unit) < 1.2 * best.deviation) unit *= 2;
    const bool up = start == 0 || decide(start, value >= start, 0);
    goOutwards(up, start, unit, value);
    while (low_ < high_) {
      const std::int64_t left = high_ - low_;
      const std::int64_t middleLeft = low_ + (left + 1) / 2;
      decide(middleLeft, value >= middleLeft,
             kHalving + (left > 3 ? 1U : 0U) + (left > 15 ? 1U : 0U));
    }
    return low_;
  }

  /// Three steps of a unit, then twice as far each time.
  void goOutwards(bool up, std::int64_t start, std::int64_t unit, std::int64_t value) {
    std::int64_t distance = unit;
    for (unsigned step = 1;; ++step) {
      const unsigned place = std::min(step, kOutwards);
      if (up) {
        const std::int64_t bound = start + distance;
        if (bound > high_ || !decide(bound, value >= bound, place)) return;
      } else {
        const std::int64_t bound = start - distance;
        if (bound <= low_ || decide(bound, value >= bound, kOutwards + place)) return;
      }
      distance = step < 3 ? distance + unit : 2 * distance;
    }
  }

  /// Whether the value is `bound` or more; `step` tells what the question is for.
  bool decide(std::int64_t bound, bool bit, unsigned step) {
    evidence_.clear();
    for (const Aim& aim : aims_) {
      for (const double share : kNarrowAndWide) evidence_.add(logitOf(aim, share, bound));
    }
    evidence_.add(byWidth_[(step * kWidths + width_) * kFractions + fraction_]);
    evidence_.add(bySituation_[(step * kSituations + prediction_->situation) * kWidths + width_]);
    evidence_.add(kBias);
    for (unsigned e = 0; e < kExact; ++e) evidence_.add(exactCounter(e, bound, stageOf(step)));
    bit = mixer_.code(coder_, bit, evidence_, {step, prediction_->situation * 3 + axis_, width_},
                      {axis_});
    if (bit) {
      low_ = bound;
    } else {
      high_ = bound - 1;
    }
    return bit;
  }

  /// The odds of the values from the bound on against those before it, if errors are distributed
  /// as a bell around the mean.
  float logitOf(const Aim& aim, double share, std::int64_t bound) const {
    constexpr double kLeast = 1e-7;
    const double scale = aim.deviation * share;
    const auto below = [&](std::int64_t x) {
      const double t = (static_cast<double>(x) - 0.5 - aim.mean) / scale;
      return 0.5 * (1 + static_cast<double>(entropy::bell(static_cast<float>(t))));
    };
    const double first = low_ == 0 ? 0 : below(low_);
    const double middle = below(bound);
    const double last = high_ == extent_[axis_] ? 1 : below(high_ + 1);
    const double upper = last - middle;
    const double lower = middle - first;
    return entropy::naturalLog(
        static_cast<float>((upper > kLeast ? upper : kLeast) / (lower > kLeast ? lower : kLeast)));
  }

  static unsigned stageOf(unsigned step) {
    if (step <= 3) return step;
    if (step <= kOutwards) return 4;
    if (step <= kOutwards + 3) return step - 6;
    return step < kHalving ? 8 : 9;
  }

  entropy::Counter& exactCounter(unsigned e, std::int64_t bound, unsigned stage) {
    const VertexPrediction::Exact& exact = prediction_->exact[e];
    const std::int64_t value = exact.value[axis_];
    const unsigned relation = value < low_ || value > high_ ? 0
                              : value == bound              ? 1
                              : value > bound               ? 2
                              : value == bound - 1          ? 3
                                                            : 4;
    const unsigned sharing = e == VertexPrediction::kShared ? prediction_->sharing[axis_] : 0;
    const std::size_t trusted =
        ((std::size_t{e} * kStages + stage) * kRelations + relation) * VertexPrediction::kTrusts +
        exact.trust[axis_];
    return byExact_[trusted * 3 + sharing];
  }

  Coder& coder_;
  GridPoint extent_;
  entropy::LayeredMixer<3> mixer_;
  entropy::Evidence evidence_;
  std::vector<entropy::Counter> byWidth_;
  std::vector<entropy::Counter> bySituation_;
  std::vector<entropy::Counter> byExact_;

  const VertexPrediction* prediction_ = nullptr;
  std::array<Aim, kGuesses> aims_{};
  unsigned axis_ = 0;
  unsigned width_ = 0;     ///< class of the best guess's deviation
  unsigned fraction_ = 0;  ///< of its mean
  std::int64_t low_ = 0;   ///< the values that are left
  std::int64_t high_ = 0;
};

}  // namespace bspc::geometry::surface
