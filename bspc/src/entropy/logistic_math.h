#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "entropy/lanes.h"

namespace bspc::entropy {

constexpr unsigned kStretchBits = 12;
/// kStretch[i]: the logit ln(p / (1 − p)) of p = (i + ½) / 4096.
extern const std::array<float, (1U << kStretchBits)> kStretch;

inline namespace BSPC_LANE_SET {

// Logarithm, power and the logistic function as polynomials: the same bits on every machine, which
// those of the C library are not. Good to about 10^-3, which is finer than any model is right.

inline std::uint32_t bitsOf(float x) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline float floatOf(std::uint32_t bits) {
  float x = 0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// `x` kept within [low, high]; `low` if it is not a number.
constexpr float clamped(float x, float low, float high) {
  const float least = x > low ? x : low;
  return least < high ? least : high;
}

BSPC_LANES_INLINE Lanes clamped(const Lanes& x, float low, float high) {
  return select(x > low, smaller(x, high), low);
}

/// Class 0 … classes − 1 of a number: the whole part of x · scale + offset, kept within.
inline unsigned classOf(float x, float scale, float offset, unsigned classes) {
  return static_cast<unsigned>(clamped(x * scale + offset, 0, static_cast<float>(classes - 1)));
}

inline float magnitude(float x) { return floatOf(bitsOf(x) & 0x7FFFFFFFU); }

/// Natural logarithm of a positive, normal number.
BSPC_LANES_INLINE float naturalLog(float x) {
  const std::uint32_t bits = bitsOf(x);
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
  const float m = floatOf((bits & 0x7FFFFFU) | 0x3F800000U) - 1.0F;
  const float log2 =
      m * (1.4426950F + m * (-0.7119F + m * (0.4396F + m * (-0.2325F + m * 0.0621F))));
  return (exponent + log2) * 0.693147181F;
}

BSPC_LANES_INLINE Lanes naturalLog(const Lanes& x) {
  const IntLanes bits = bitsOf(x);
  const Lanes exponent = converted((bits >> 23) - 127);
  const Lanes m = lanesOf((bits & 0x7FFFFF) | 0x3F800000) - 1.0F;
  const Lanes log2 =
      m * (1.4426950F + m * (-0.7119F + m * (0.4396F + m * (-0.2325F + m * 0.0621F))));
  return (exponent + log2) * 0.693147181F;
}

/// 2^x for −100 ≤ x ≤ 100, that of the nearer end beyond.
BSPC_LANES_INLINE float exp2(float x) {
  x = clamped(x, -100, 100);
  // 1 below 0; by a mask, as no processor foresees the sign.
  const float below = floatOf(0x3F800000U & (0U - static_cast<std::uint32_t>(x < 0)));
  const int whole = static_cast<int>(x - below);
  const float f = x - static_cast<float>(whole);
  const float p =
      1 + f * (0.693147F + f * (0.240227F + f * (0.0555041F + f * (0.0096181F + f * 0.0013333F))));
  return p * floatOf(static_cast<std::uint32_t>(whole + 127) << 23);
}

/// The same of each lane.
BSPC_LANES_INLINE Lanes exp2(const Lanes& number) {
  const Lanes x = clamped(number, -100, 100);
  const IntLanes whole = truncated(select(x < 0.0F, x - 1.0F, x));
  const Lanes f = x - converted(whole);
  const Lanes p =
      1.0F +
      f * (0.693147F + f * (0.240227F + f * (0.0555041F + f * (0.0096181F + f * 0.0013333F))));
  return p * lanesOf((whole + 127) << 23);
}

/// Twice the binary logarithm of a positive number, rounded down (linear between powers of two).
inline int halfOctave(float x) { return static_cast<int>(bitsOf(x) >> 22) - 254; }

/// Probability whose logit is `x`: 1 / (1 + e^−x).
BSPC_LANES_INLINE float squash(float x) { return 1 / (1 + exp2(-x * 1.44269504F)); }

BSPC_LANES_INLINE Lanes squash(const Lanes& x) { return 1.0F / (1.0F + exp2(x * -1.44269504F)); }

/// A bell's distribution function from −1 to 1 with heavy tails: ± (1 − 1 / (1 + |t| + t²)).
BSPC_LANES_INLINE float bell(float t) {
  const float a = magnitude(t) + t * t;
  const float r = a / (1 + a);
  return floatOf(bitsOf(r) | (bitsOf(t) & 0x80000000U));
}

BSPC_LANES_INLINE Lanes bell(const Lanes& t) {
  const Lanes a = magnitude(t) + t * t;
  const Lanes r = a / (1.0F + a);
  return lanesOf(bitsOf(r) | (bitsOf(t) & INT32_MIN));
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::entropy
