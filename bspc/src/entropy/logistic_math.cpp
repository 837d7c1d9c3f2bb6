#include "entropy/logistic_math.h"

namespace bspc::entropy {

namespace {

/// ln((1 + t) / (1 − t)) = 2 (t + t³/3 + t⁵/5 + …) in double precision, in a written order.
constexpr double twiceArtanh(double t) {
  const double square = t * t;
  double series = 0;
  for (int k = 25; k >= 1; k -= 2) series = series * square + 1.0 / k;
  return 2 * t * series;
}

constexpr double kLn2 = 0.6931471805599453;

constexpr double preciseLog(double x) {
  int exponent = 0;
  while (x > 1.5) {
    x *= 0.5;
    ++exponent;
  }
  while (x < 0.75) {
    x *= 2;
    --exponent;
  }
  return exponent * kLn2 + twiceArtanh((x - 1) / (x + 1));
}

std::array<float, (1U << kStretchBits)> stretchTable() {
  constexpr unsigned kSize = 1U << kStretchBits;
  std::array<float, kSize> table{};
  for (unsigned i = 0; i < kSize; ++i) {
    const double p = (i + 0.5) / kSize;
    table[i] = static_cast<float>(preciseLog(p) - preciseLog(1 - p));
  }
  return table;
}

}  // namespace

const std::array<float, (1U << kStretchBits)> kStretch = stretchTable();

}  // namespace bspc::entropy
