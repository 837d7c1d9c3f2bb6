#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "attributes/octahedral_map.h"
#include "attributes/residual_coder.h"

namespace bspc::attributes {

/// Predicts the words of a tuple, one after the other, from those of weighted neighbours and from
/// the words of the same tuple that came before. The decoder repeats every operation.
template <class Word>
class TuplePredictor {
 public:
  using Domain = ResidualSettings::Domain;

  TuplePredictor(const ResidualSettings& settings, const std::vector<Word>& words)
      : settings_(settings), words_(words), sphere_(std::max(settings.sphereHalf, 1U)) {
    if (settings.domain == Domain::Sphere) {
      directions_.resize(words.size() / 2);
    }
  }

  /// Sphere only: the words of a tuple as they are predicted and coded, and back.
  std::array<Word, 2> toChart(const Word* tuple) const {
    return words(chart_.toChart(sphere_, place(tuple)));
  }
  std::array<Word, 2> fromChart(const Word* coded) const {
    return words(chart_.fromChart(sphere_, place(coded)));
  }

  /// Sphere only: takes up the direction of a tuple that is known now.
  void learn(std::size_t rank) {
    if (settings_.domain != Domain::Sphere) return;
    const OctahedralMap::Vector d = sphere_.direction(place(words_.data() + 2 * rank));
    for (unsigned k = 0; k < 3; ++k) directions_[rank][k] = static_cast<float>(d[k]);
  }

  /// Begins a tuple.
  void start(const WeightedNeighbours& neighbours) {
    near_ = &neighbours;
    if (settings_.domain == Domain::Unit) startUnit();
    if (settings_.domain == Domain::Sphere) startSphere();
  }

  /// The component that is coded i-th.
  std::uint32_t component(std::uint32_t i) const {
    return settings_.domain == Domain::Unit ? unitOrder_[i] : i;
  }

  /// What is expected of it; `tuple` holds the tuple's words so far.
  Word predict(std::uint32_t i, const Word* tuple) const {
    if (settings_.domain == Domain::Sphere) return static_cast<Word>(place_[i]);
    if (near_->ranks.empty()) return zeroWord<Word>(settings_.kind);
    switch (settings_.domain) {
      case Domain::Unit:
        return predictUnit(i, tuple);
      case Domain::Numbers:
        return predictNumber(i);
      default:
        return predictWord(i);
    }
  }

 private:
  Word word(std::size_t j, std::uint32_t component) const {
    return words_[std::size_t{near_->ranks[j]} * settings_.components + component];
  }

  Word predictWord(std::uint32_t component) const {
    constexpr double kGreatest = 0x1p62;
    using Signed = std::make_signed_t<Word>;
    const Word base = word(0, component);
    double sum = 0;
    for (std::size_t j = 1; j < near_->ranks.size(); ++j) {
      const auto difference = static_cast<Signed>(static_cast<Word>(word(j, component) - base));
      sum += near_->weights[j] * static_cast<double>(difference);
    }
    if (!(std::fabs(sum) < kGreatest)) return base;
    return static_cast<Word>(base +
                             static_cast<Word>(static_cast<std::int64_t>(std::floor(sum + 0.5))));
  }

  /// The mean of the neighbours' numbers.
  double mean(std::uint32_t component) const {
    double sum = 0;
    if constexpr (sizeof(Word) >= 4) {
      for (std::size_t j = 0; j < near_->ranks.size(); ++j) {
        sum += near_->weights[j] * numberOfWord(word(j, component));
      }
    }
    return sum;
  }

  /// The word of a number, or the nearest neighbour's if the type cannot hold the number.
  Word wordOrNearest(double number, std::uint32_t component) const {
    if constexpr (sizeof(Word) >= 4) {
      const auto greatest = static_cast<double>(std::numeric_limits<FloatOf<Word>>::max());
      if (std::fabs(number) <= greatest) return wordOfNumber<Word>(number);
    }
    return word(0, component);
  }

  Word predictNumber(std::uint32_t component) const {
    return wordOrNearest(mean(component), component);
  }

  /// The two components that are expected to be smaller come first; the third follows from them.
  void startUnit() {
    if (near_->ranks.empty()) {
      unitOrder_ = {0, 1, 2};
      return;
    }
    for (std::uint32_t c = 0; c < 3; ++c) expected_[c] = mean(c);
    std::uint32_t last = 0;
    for (std::uint32_t c = 1; c < 3; ++c) {
      if (std::fabs(expected_[c]) > std::fabs(expected_[last])) last = c;
    }
    unitOrder_ = {last == 0 ? 1U : 0U, last == 2 ? 1U : 2U, last};
  }

  Word predictUnit(std::uint32_t i, const Word* tuple) const {
    const std::uint32_t component = unitOrder_[i];
    if constexpr (sizeof(Word) >= 4) {
      if (i == 2) {
        const double a = numberOfWord(tuple[unitOrder_[0]]);
        const double b = numberOfWord(tuple[unitOrder_[1]]);
        const double rest = 1.0 - a * a - b * b;
        const double size = rest > 0 ? std::sqrt(rest) : 0.0;
        return wordOfNumber<Word>(expected_[component] < 0 ? -size : size);
      }
    }
    return wordOrNearest(expected_[component], component);
  }

  void startSphere() {
    OctahedralMap::Vector sum{};
    for (std::size_t j = 0; j < near_->ranks.size(); ++j) {
      const std::array<float, 3>& d = directions_[near_->ranks[j]];
      for (unsigned k = 0; k < 3; ++k) sum[k] += near_->weights[j] * static_cast<double>(d[k]);
    }
    chart_ = OctahedralChart(sum);
    place_ = chart_.place(sphere_, sum);
  }

  static OctahedralMap::Place place(const Word* tuple) {
    return {static_cast<std::uint32_t>(tuple[0]), static_cast<std::uint32_t>(tuple[1])};
  }
  static std::array<Word, 2> words(const OctahedralMap::Place& place) {
    return {static_cast<Word>(place[0]), static_cast<Word>(place[1])};
  }

  const ResidualSettings& settings_;
  const std::vector<Word>& words_;
  const WeightedNeighbours* near_ = nullptr;
  std::array<double, 3> expected_{};
  std::array<std::uint32_t, 3> unitOrder_{};
  OctahedralMap sphere_;
  OctahedralChart chart_{OctahedralMap::Vector{}};
  OctahedralMap::Place place_{};
  std::vector<std::array<float, 3>> directions_;
};

}  // namespace bspc::attributes
