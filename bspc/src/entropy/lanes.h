#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "entropy/lane_set.h"

/// Lanes are passed in registers only where functions are truly inline.
#define BSPC_LANES_INLINE inline __attribute__((always_inline))

namespace bspc::entropy {
inline namespace BSPC_LANE_SET {

// Eight numbers at a time, in whatever vector registers there are. Each lane is IEEE arithmetic of
// its own and sums over lanes have a written order, so the results are the same everywhere.

constexpr std::size_t kLanes = 8;

namespace lane_detail {

#if defined(BSPC_LANES_AVX2)
constexpr unsigned kRegisterBytes = 32;
#else
constexpr unsigned kRegisterBytes = 16;
#endif
constexpr unsigned kRegisters = 32 / kRegisterBytes;

/// For each set of lanes their numbers in front, in ascending order.
constexpr std::array<std::array<std::uint8_t, kLanes>, 1U << kLanes> packingOrders() {
  std::array<std::array<std::uint8_t, kLanes>, 1U << kLanes> orders{};
  for (unsigned bits = 0; bits < orders.size(); ++bits) {
    unsigned count = 0;
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if ((bits >> lane & 1) != 0) orders[bits][count++] = static_cast<std::uint8_t>(lane);
    }
  }
  return orders;
}

inline constexpr auto kPackingOrders = packingOrders();

using FloatRegister = float __attribute__((vector_size(kRegisterBytes)));
using IntRegister = std::int32_t __attribute__((vector_size(kRegisterBytes)));

}  // namespace lane_detail

/// Eight whole numbers, or a mask: all bits of a lane are set where a comparison holds.
struct IntLanes {
  lane_detail::IntRegister part[lane_detail::kRegisters] = {};

  IntLanes() = default;
  BSPC_LANES_INLINE IntLanes(std::int32_t x) {  // NOLINT: a number stands for eight of it
    for (auto& p : part) p = x - lane_detail::IntRegister{};
  }

#define BSPC_LANES_OPERATOR(op)                                                                \
  BSPC_LANES_INLINE friend IntLanes operator op(const IntLanes& a, const IntLanes& b) {        \
    IntLanes r;                                                                                \
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] op b.part[i]; \
    return r;                                                                                  \
  }
  BSPC_LANES_OPERATOR(&)
  BSPC_LANES_OPERATOR(|)
  BSPC_LANES_OPERATOR(+)
  BSPC_LANES_OPERATOR(-)
#undef BSPC_LANES_OPERATOR
  BSPC_LANES_INLINE friend IntLanes operator<(const IntLanes& a, const IntLanes& b) {
    IntLanes r;
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] < b.part[i];
    return r;
  }
  BSPC_LANES_INLINE friend IntLanes operator~(const IntLanes& a) {
    IntLanes r;
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = ~a.part[i];
    return r;
  }
  BSPC_LANES_INLINE friend IntLanes operator<<(const IntLanes& a, int shift) {
    IntLanes r;
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] << shift;
    return r;
  }
  BSPC_LANES_INLINE friend IntLanes operator>>(const IntLanes& a, int shift) {
    IntLanes r;
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] >> shift;
    return r;
  }
  BSPC_LANES_INLINE IntLanes& operator|=(const IntLanes& b) { return *this = *this | b; }
};

struct Lanes {
  lane_detail::FloatRegister part[lane_detail::kRegisters] = {};

  Lanes() = default;
  BSPC_LANES_INLINE Lanes(float x) {  // NOLINT: a number stands for eight of it
    for (auto& p : part) p = x - lane_detail::FloatRegister{};
  }

#define BSPC_LANES_OPERATOR(op)                                                                \
  BSPC_LANES_INLINE friend Lanes operator op(const Lanes& a, const Lanes& b) {                 \
    Lanes r;                                                                                   \
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] op b.part[i]; \
    return r;                                                                                  \
  }
  BSPC_LANES_OPERATOR(+)
  BSPC_LANES_OPERATOR(-)
  BSPC_LANES_OPERATOR(*)
  BSPC_LANES_OPERATOR(/)
#undef BSPC_LANES_OPERATOR
#define BSPC_LANES_COMPARISON(op)                                                              \
  BSPC_LANES_INLINE friend IntLanes operator op(const Lanes& a, const Lanes& b) {              \
    IntLanes r;                                                                                \
    for (unsigned i = 0; i < lane_detail::kRegisters; ++i) r.part[i] = a.part[i] op b.part[i]; \
    return r;                                                                                  \
  }
  BSPC_LANES_COMPARISON(<)
  BSPC_LANES_COMPARISON(<=)
  BSPC_LANES_COMPARISON(>)
  BSPC_LANES_COMPARISON(>=)
#undef BSPC_LANES_COMPARISON
  BSPC_LANES_INLINE Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  BSPC_LANES_INLINE Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
};

/// How many entries arrays of `count` values are padded to.
constexpr unsigned wholeLanes(std::size_t count) {
  return static_cast<unsigned>((count + kLanes - 1) & ~(kLanes - 1));
}

BSPC_LANES_INLINE Lanes load(const float* from) {
  Lanes v;
  std::memcpy(v.part, from, sizeof v.part);
  return v;
}

BSPC_LANES_INLINE void store(float* to, const Lanes& v) { std::memcpy(to, v.part, sizeof v.part); }

BSPC_LANES_INLINE void store(std::int32_t* to, const IntLanes& v) {
  std::memcpy(to, v.part, sizeof v.part);
}

/// first, first + 1, …, first + 7
BSPC_LANES_INLINE IntLanes laneNumbers(unsigned first) {
  IntLanes numbers;
  for (unsigned i = 0; i < lane_detail::kRegisters; ++i) {
    for (unsigned j = 0; j < kLanes / lane_detail::kRegisters; ++j) {
      numbers.part[i][j] =
          static_cast<std::int32_t>(first + i * (kLanes / lane_detail::kRegisters) + j);
    }
  }
  return numbers;
}

BSPC_LANES_INLINE std::array<float, kLanes> valuesOf(const Lanes& v) {
  std::array<float, kLanes> values{};
  store(values.data(), v);
  return values;
}

BSPC_LANES_INLINE IntLanes bitsOf(const Lanes& v) {
  IntLanes bits;
  std::memcpy(bits.part, v.part, sizeof v.part);
  return bits;
}

BSPC_LANES_INLINE Lanes lanesOf(const IntLanes& bits) {
  Lanes v;
  std::memcpy(v.part, bits.part, sizeof v.part);
  return v;
}

/// Whole numbers as floating point.
BSPC_LANES_INLINE Lanes converted(const IntLanes& numbers) {
  Lanes v;
  for (unsigned i = 0; i < lane_detail::kRegisters; ++i) {
    v.part[i] = __builtin_convertvector(numbers.part[i], lane_detail::FloatRegister);
  }
  return v;
}

/// Numbers without their fractions; each must fit.
BSPC_LANES_INLINE IntLanes truncated(const Lanes& v) {
  IntLanes numbers;
  for (unsigned i = 0; i < lane_detail::kRegisters; ++i) {
    numbers.part[i] = __builtin_convertvector(v.part[i], lane_detail::IntRegister);
  }
  return numbers;
}

BSPC_LANES_INLINE Lanes magnitude(const Lanes& v) {
  return lanesOf(bitsOf(v) & IntLanes(0x7FFFFFFF));
}

/// `a` where the mask is set, `b` elsewhere.
BSPC_LANES_INLINE Lanes select(const IntLanes& mask, const Lanes& a, const Lanes& b) {
  return lanesOf((bitsOf(a) & mask) | (bitsOf(b) & ~mask));
}

/// `v` where the mask is set, 0 elsewhere.
BSPC_LANES_INLINE Lanes only(const IntLanes& mask, const Lanes& v) {
  return lanesOf(bitsOf(v) & mask);
}

BSPC_LANES_INLINE Lanes smaller(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }

/// ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7))
BSPC_LANES_INLINE float sum(const Lanes& v) {
  using Half = float __attribute__((vector_size(16)));
  Half half[2];
  std::memcpy(half, v.part, sizeof half);
  const Half pairs = half[0] + half[1];
  return (pairs[0] + pairs[2]) + (pairs[1] + pairs[3]);
}

/// Lane i is the sum over vector i, added up in the order of sum().
BSPC_LANES_INLINE Lanes sums(const std::array<Lanes, kLanes>& vectors) {
  using Half = float __attribute__((vector_size(16)));
#if defined(__clang__)
#define BSPC_LANES_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
  using Order = std::int32_t __attribute__((vector_size(16)));
#define BSPC_LANES_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, Order{__VA_ARGS__})
#endif
  Half fours[2];
  for (unsigned i = 0; i < 2; ++i) {
    Half pairs[4];
    for (unsigned j = 0; j < 4; ++j) {
      Half half[2];
      std::memcpy(half, vectors[4 * i + j].part, sizeof half);
      pairs[j] = half[0] + half[1];
    }
    for (unsigned j = 0; j < 4; j += 2) {
      pairs[j] = BSPC_LANES_SHUFFLE(pairs[j], pairs[j + 1], 0, 1, 4, 5) +
                 BSPC_LANES_SHUFFLE(pairs[j], pairs[j + 1], 2, 3, 6, 7);
    }
    fours[i] = BSPC_LANES_SHUFFLE(pairs[0], pairs[2], 0, 2, 4, 6) +
               BSPC_LANES_SHUFFLE(pairs[0], pairs[2], 1, 3, 5, 7);
  }
#undef BSPC_LANES_SHUFFLE
  Lanes result;
  std::memcpy(result.part, fours, sizeof fours);
  return result;
}

BSPC_LANES_INLINE float least(const Lanes& v) {
  using Half = float __attribute__((vector_size(16)));
  Half half[2];
  std::memcpy(half, v.part, sizeof half);
  const Half four = half[0] < half[1] ? half[0] : half[1];
  const float even = four[0] < four[2] ? four[0] : four[2];
  const float odd = four[1] < four[3] ? four[1] : four[3];
  return even < odd ? even : odd;
}

/// Bit i is set where lane i of the mask is.
BSPC_LANES_INLINE std::uint32_t maskBits(const IntLanes& mask) {
#if defined(BSPC_LANES_AVX2)
  __m256 bits;
  std::memcpy(&bits, mask.part, sizeof bits);
  return static_cast<std::uint32_t>(_mm256_movemask_ps(bits));
#elif defined(__SSE2__)
  __m128 half[2];
  std::memcpy(half, mask.part, sizeof half);
  return static_cast<std::uint32_t>(_mm_movemask_ps(half[0]) | (_mm_movemask_ps(half[1]) << 4));
#else
  std::uint32_t bits = 0;
  std::int32_t lanes[kLanes];
  std::memcpy(lanes, mask.part, sizeof lanes);
  for (unsigned i = 0; i < kLanes; ++i) bits |= (lanes[i] != 0 ? 1U : 0U) << i;
  return bits;
#endif
}

/// Which lanes of several vectors to keep, side by side: those whose bits are set.
class Packing {
 public:
  BSPC_LANES_INLINE explicit Packing(std::uint32_t bits)
      : count_(static_cast<unsigned>(__builtin_popcount(bits))) {
#if defined(BSPC_LANES_AVX2)
    std::int64_t order = 0;
    std::memcpy(&order, lane_detail::kPackingOrders[bits & 0xFF].data(), sizeof order);
    order_ = _mm256_cvtepi8_epi32(_mm_cvtsi64_si128(order));
#else
    order_ = lane_detail::kPackingOrders[bits & 0xFF];
#endif
  }

  unsigned count() const { return count_; }

  /// Stores the lanes that are kept; eight entries from `to` on are written whatever count() is.
  BSPC_LANES_INLINE void store(float* to, const Lanes& v) const {
#if defined(BSPC_LANES_AVX2)
    __m256 values;
    std::memcpy(&values, v.part, sizeof values);
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(values, order_));
#else
    const std::array<float, kLanes> values = valuesOf(v);
    for (unsigned i = 0; i < kLanes; ++i) to[i] = values[order_[i]];
#endif
  }

 private:
  unsigned count_;
#if defined(BSPC_LANES_AVX2)
  __m256i order_;
#else
  std::array<std::uint8_t, kLanes> order_;
#endif
};

}  // namespace BSPC_LANE_SET
}  // namespace bspc::entropy
