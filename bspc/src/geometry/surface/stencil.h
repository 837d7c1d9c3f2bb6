#pragma once

#include <array>
#include <cmath>

#include "geometry/surface/vector3.h"

namespace bspc::geometry::surface {

/// Learns by least squares with which weights vectors add up to another: what was seen long ago
/// counts less and less.
template <unsigned Size>
class Stencil {
 public:
  using Vectors = std::array<Vector3, Size>;

  /// The sum of the vectors with the best weights so far.
  Vector3 estimate(const Vectors& vectors) const {
    std::array<double, Size> weight = weights();
    Vector3 sum{};
    for (unsigned i = 0; i < Size; ++i) sum = sum + weight[i] * vectors[i];
    return sum;
  }

  void learn(const Vectors& vectors, const Vector3& target) {
    for (unsigned i = 0; i < Size; ++i) {
      for (unsigned j = 0; j <= i; ++j) {
        products_[i][j] = products_[i][j] * kDecay + dot(vectors[i], vectors[j]);
      }
      right_[i] = right_[i] * kDecay + dot(vectors[i], target);
    }
  }

 private:
  static constexpr double kDecay = 0.99;
  static constexpr double kRidge = 1;
  static constexpr double kShare = 0.001;
  static constexpr double kLeast = 1e-9;

  /// By Cholesky's method, with something added to the diagonal.
  std::array<double, Size> weights() const {
    std::array<std::array<double, Size>, Size> root{};
    std::array<double, Size> y{};
    for (unsigned i = 0; i < Size; ++i) {
      for (unsigned j = 0; j <= i; ++j) {
        double sum = products_[i][j];
        if (i == j) sum = sum + (kRidge + kShare * products_[i][i]);
        for (unsigned k = 0; k < j; ++k) sum = sum - root[i][k] * root[j][k];
        root[i][j] = i == j ? std::sqrt(sum > kLeast ? sum : kLeast) : sum / root[j][j];
      }
      double sum = right_[i];
      for (unsigned k = 0; k < i; ++k) sum = sum - root[i][k] * y[k];
      y[i] = sum / root[i][i];
    }
    std::array<double, Size> weight{};
    for (unsigned i = Size; i-- > 0;) {
      double sum = y[i];
      for (unsigned k = i + 1; k < Size; ++k) sum = sum - root[k][i] * weight[k];
      weight[i] = sum / root[i][i];
    }
    return weight;
  }

  std::array<std::array<double, Size>, Size> products_{};
  std::array<double, Size> right_{};
};

}  // namespace bspc::geometry::surface
