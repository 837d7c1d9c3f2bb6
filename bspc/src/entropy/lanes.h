#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace bspc::entropy {

// Eight numbers at a time. Compilers make of it whatever vector instructions the machine has; each
// lane is IEEE arithmetic of its own and sums over lanes have a written order, so the results are
// the same everywhere.

constexpr std::size_t kLanes = 8;

using Lanes = float __attribute__((vector_size(32)));
/// Whole numbers, or masks: all bits of a lane are set where a comparison holds.
using IntLanes = std::int32_t __attribute__((vector_size(32)));

/// How many entries arrays of `count` values are padded to.
constexpr std::size_t wholeLanes(std::size_t count) { return (count + kLanes - 1) & ~(kLanes - 1); }

inline Lanes load(const float* from) {
  Lanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

inline void store(float* to, const Lanes& v) { std::memcpy(to, &v, sizeof v); }

inline Lanes allLanes(float x) { return Lanes{x, x, x, x, x, x, x, x}; }

inline IntLanes bitsOf(const Lanes& v) {
  IntLanes bits;
  std::memcpy(&bits, &v, sizeof bits);
  return bits;
}

inline Lanes lanesOf(const IntLanes& bits) {
  Lanes v;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}

inline Lanes magnitude(const Lanes& v) { return lanesOf(bitsOf(v) & 0x7FFFFFFF); }

/// `a` where the mask is set, `b` elsewhere.
inline Lanes select(const IntLanes& mask, const Lanes& a, const Lanes& b) {
  return lanesOf((bitsOf(a) & mask) | (bitsOf(b) & ~mask));
}

/// `v` where the mask is set, 0 elsewhere.
inline Lanes only(const IntLanes& mask, const Lanes& v) { return lanesOf(bitsOf(v) & mask); }

inline Lanes smaller(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }

/// ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7))
inline float sum(const Lanes& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

inline float least(const Lanes& v) {
  float best = v[0];
  for (unsigned i = 1; i < kLanes; ++i) best = v[i] < best ? v[i] : best;
  return best;
}

/// Bit i is set where lane i of the mask is.
inline std::uint32_t maskBits(const IntLanes& mask) {
#if defined(__AVX__)
  return static_cast<std::uint32_t>(
      _mm256_movemask_ps(_mm256_castsi256_ps(reinterpret_cast<const __m256i&>(mask))));
#elif defined(__SSE2__)
  __m128i half[2];
  std::memcpy(half, &mask, sizeof half);
  return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(half[0])) |
                                    (_mm_movemask_ps(_mm_castsi128_ps(half[1])) << 4));
#else
  std::uint32_t bits = 0;
  for (unsigned i = 0; i < kLanes; ++i) bits |= (mask[i] != 0 ? 1U : 0U) << i;
  return bits;
#endif
}

}  // namespace bspc::entropy
