#include "grid/ratio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>

namespace bspc::lattice {

namespace {

constexpr std::uint64_t kMaxOdd = std::uint64_t{1} << 53;

int makeOdd(std::uint64_t& value) {
  int exponent = 0;
  while (value % 2 == 0) {
    value /= 2;
    ++exponent;
  }
  return exponent;
}

std::optional<std::uint64_t> power(std::uint64_t base, int exponent) {
  std::uint64_t result = 1;
  for (int i = 0; i < exponent; ++i) {
    if (result > kMaxOdd / base) return std::nullopt;
    result *= base;
  }
  return result;
}

}  // namespace

double Ratio::value() const {
  return std::ldexp(static_cast<double>(numerator) / static_cast<double>(denominator), exponent);
}

Ratio makeRatio(std::uint64_t numerator, std::uint64_t denominator, int exponent) {
  exponent += makeOdd(numerator) - makeOdd(denominator);
  const std::uint64_t common = std::gcd(numerator, denominator);
  return {numerator / common, denominator / common, exponent};
}

std::optional<Ratio> commonDivisor(const Ratio& a, const Ratio& b) {
  const std::uint64_t factor = b.denominator / std::gcd(a.denominator, b.denominator);
  if (a.denominator > (kMaxOdd - 1) / factor) return std::nullopt;
  return Ratio{std::gcd(a.numerator, b.numerator), a.denominator * factor,
               std::min(a.exponent, b.exponent)};
}

std::optional<Ratio> decimalRatio(double value) {
  std::array<char, 40> text{};
  for (int digits = 0; digits < 17; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*e", digits, value);
    // Both directions use the same locale, so a decimal comma does no harm.
    if (std::strtod(text.data(), nullptr) == value) break;
  }
  const std::string number = text.data();
  const std::size_t mark = number.find('e');
  std::uint64_t mantissa = 0;
  int exponent = std::atoi(number.c_str() + mark + 1);
  std::size_t digitCount = 0;
  for (const char c : number.substr(0, mark)) {
    if (c < '0' || c > '9') continue;
    mantissa = mantissa * 10 + static_cast<std::uint64_t>(c - '0');
    if (digitCount++ > 0) --exponent;
  }
  // 10^e = 5^e · 2^e: only the fives can grow too large.
  const auto fives = power(5, std::abs(exponent));
  if (mantissa == 0 || !fives) return std::nullopt;
  if (exponent < 0) {
    const Ratio ratio = makeRatio(mantissa, *fives, exponent);
    if (ratio.numerator < kMaxOdd) return ratio;
  } else if (mantissa <= kMaxOdd / *fives) {
    return makeRatio(mantissa * *fives, 1, exponent);
  }
  return std::nullopt;
}

bool setRational(Grid::Axis& axis, const Ratio& ratio) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 62;
  if (ratio.exponent > 62 || ratio.exponent < -62) return false;
  if (ratio.numerator >= kMaxOdd || ratio.denominator >= kMaxOdd) return false;
  const int up = std::max(ratio.exponent, 0);
  const int down = std::max(-ratio.exponent, 0);
  if (ratio.numerator > (kMax >> up) || ratio.denominator > (kMax >> down)) return false;
  axis.numerator = static_cast<std::int64_t>(ratio.numerator << up);
  axis.denominator = static_cast<std::int64_t>(ratio.denominator << down);
  return true;
}

Grid gridOf(ScalarType type, const Ratio& ratio) {
  Grid grid;
  grid.scalarType = type;
  for (Grid::Axis& axis : grid.axes) {
    if (setRational(axis, ratio)) continue;
    grid.form = Grid::Form::Affine;
    axis = Grid::Axis{};
    axis.step = ratio.value();
  }
  return grid;
}

}  // namespace bspc::lattice
