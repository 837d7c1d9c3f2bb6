#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "bspc/error.h"
#include "bspc/grid.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"

namespace bspc::geometry::fast {

/// Points one after the other in the order of the input, each coordinate predicted from the points
/// before it: for scan lines, depth cameras, and meshes whose vertices lie along strips.
///
/// Coder is SymbolWriter or SymbolReader.
template <class Coder>
class OrderCoder {
 public:
  explicit OrderCoder(const GridPoint& extent) : extent_(extent) {}

  /// Codes the next point; a reader fills it in.
  void code(Coder& coder, GridPoint& point) {
    for (unsigned k = 0; k < 3; ++k) {
      Axis& axis = axes_[k];
      const Predictions predictions = axis.predict(extent_[k]);
      const std::int64_t expected = predictions[axis.best];
      const std::int64_t error =
          codeError(coder, axis, k, static_cast<std::int64_t>(point[k]) - expected);
      const std::int64_t value = expected + error;
      if (value < 0 || value > extent_[k]) {
        throw Error(ErrorCode::Corrupt, "a point lies outside of its tile: the file is damaged");
      }
      point[k] = static_cast<std::uint32_t>(value);
      learn(axis, k, predictions, value, error);
    }
  }

  /// Takes note of a point that is known already.
  void pass(const GridPoint& point) {
    for (unsigned k = 0; k < 3; ++k) {
      Axis& axis = axes_[k];
      const Predictions predictions = axis.predict(extent_[k]);
      learn(axis, k, predictions, point[k], point[k] - predictions[axis.best]);
    }
  }

 private:
  static constexpr unsigned kPredictors = 4;
  static constexpr unsigned kMaxLength = 33;  ///< bits of an error's magnitude
  static constexpr unsigned kSizes = 40;
  static constexpr unsigned kBesides = 6;
  using Predictions = std::array<std::int64_t, kPredictors>;
  using Bit = entropy::AdaptiveBit;

  /// What is remembered along an axis.
  struct Axis {
    std::int64_t last[3] = {};                      ///< values, newest first
    std::array<std::uint64_t, kPredictors> loss{};  ///< recent errors of the predictors
    unsigned best = 0;
    std::uint64_t size = 0;  ///< recent magnitude of errors, in 1/16
    unsigned lastSign = 1;   ///< 0 negative, 1 zero, 2 positive

    Predictions predict(std::uint32_t extent) const {
      const std::int64_t step = last[0] - last[1];
      const std::int64_t stepBefore = last[1] - last[2];
      Predictions p = {last[0], last[0] + step, last[0] + (step >> 1),
                       last[0] + ((step + stepBefore) >> 1)};
      for (std::int64_t& v : p) v = std::clamp<std::int64_t>(v, 0, extent);
      return p;
    }
  };

  struct Models {
    std::array<std::array<std::array<Bit, kMaxLength + 1>, kBesides>, kSizes> length;
    std::array<std::array<Bit, 3>, kMaxLength + 1> sign;
    std::array<std::array<Bit, 4>, kMaxLength + 1> mantissa;
  };

  /// Twice the logarithm of a magnitude in 1/16, in half steps.
  static unsigned sizeClass(std::uint64_t size) {
    const unsigned length = entropy::bitLength(size);
    const unsigned half = length >= 2 ? static_cast<unsigned>((size >> (length - 2)) & 1) : 0;
    return std::min(2 * length + half, kSizes - 1);
  }

  std::int64_t codeError(Coder& coder, const Axis& axis, unsigned k, std::int64_t error) {
    Models& models = models_[k];
    const std::uint64_t magnitude =
        error < 0 ? static_cast<std::uint64_t>(-error) : static_cast<std::uint64_t>(error);
    const unsigned wanted = entropy::bitLength(magnitude);
    auto& lengths = models.length[sizeClass(axis.size)][beside(k)];
    unsigned length = 0;
    while (length < kMaxLength && coder.bit(lengths[length], length < wanted)) ++length;
    if (length == 0) return 0;
    const bool negative = coder.bit(models.sign[length][axis.lastSign], error < 0);
    std::uint64_t value = 1;
    unsigned left = length - 1;
    for (unsigned node = 1; left > 0 && node < 4;) {
      --left;
      const bool one = coder.bit(models.mantissa[length][node], ((magnitude >> left) & 1) != 0);
      value = 2 * value + (one ? 1 : 0);
      node = 2 * node + (one ? 1 : 0);
    }
    const std::uint64_t low = magnitude & ((std::uint64_t{1} << left) - 1);
    value = (value << left) | (left > 0 ? coder.wide(low, left) : 0);
    return negative ? -static_cast<std::int64_t>(value) : static_cast<std::int64_t>(value);
  }

  /// How large the errors of the point's coordinates before this one are, against the usual.
  unsigned beside(unsigned k) const {
    if (k == 0) return 0;
    const std::uint64_t now = std::max(beside_[0], k == 2 ? beside_[1] : 0);
    return 1 + std::min<unsigned>(static_cast<unsigned>(now), kBesides - 2);
  }

  void learn(Axis& axis, unsigned k, const Predictions& predictions, std::int64_t value,
             std::int64_t error) {
    unsigned best = 0;
    for (unsigned p = 0; p < kPredictors; ++p) {
      const auto off = static_cast<std::uint64_t>(std::llabs(value - predictions[p]));
      axis.loss[p] += 16 * off - (axis.loss[p] >> 4);
      if (axis.loss[p] < axis.loss[best]) best = p;
    }
    axis.best = best;
    const auto magnitude = static_cast<std::uint64_t>(std::llabs(error));
    if (k < 2) {
      const unsigned usual = sizeClass(axis.size);
      const unsigned now = sizeClass(16 * magnitude);
      beside_[k] = now + 4 < usual   ? 0
                   : now + 2 < usual ? 1
                   : now < usual + 2 ? 2
                   : now < usual + 4 ? 3
                                     : 4;
    }
    axis.size = (3 * axis.size + 16 * magnitude + 2) >> 2;
    axis.lastSign = error < 0 ? 0 : error == 0 ? 1 : 2;
    axis.last[2] = axis.last[1];
    axis.last[1] = axis.last[0];
    axis.last[0] = value;
  }

  GridPoint extent_;
  std::array<Axis, 3> axes_{};
  std::array<Models, 3> models_;
  std::array<unsigned, 2> beside_{};
};

}  // namespace bspc::geometry::fast
