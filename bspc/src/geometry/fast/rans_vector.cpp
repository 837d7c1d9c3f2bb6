#include "geometry/fast/rans_vector.h"

#include <array>

#include "bspc/error.h"
#include "geometry/fast/rans.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define BSPC_VECTOR_RANS 1
#include <immintrin.h>
#endif

namespace bspc::geometry::fast {

#ifdef BSPC_VECTOR_RANS

namespace {

/// For each set of lanes that need a word, which of the next eight words each lane takes.
using Shares = std::array<std::array<std::uint8_t, 8>, 256>;

constexpr Shares makeShares() {
  Shares shares{};
  for (unsigned needy = 0; needy < 256; ++needy) {
    std::uint8_t next = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      shares[needy][lane] = next;
      if (((needy >> lane) & 1) != 0) ++next;
    }
  }
  return shares;
}

constexpr Shares kShares = makeShares();

/// For each set of lanes that give off a word, those lanes side by side at the end.
constexpr Shares makeGivers() {
  Shares givers{};
  for (unsigned full = 0; full < 256; ++full) {
    unsigned place = 8;
    for (unsigned lane = 8; lane-- > 0;) {
      if (((full >> lane) & 1) != 0) givers[full][--place] = static_cast<std::uint8_t>(lane);
    }
  }
  return givers;
}

constexpr Shares kGivers = makeGivers();

}  // namespace

bool hasVectorRans() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

// What follows is inlined: vectors that pass through memory would wait for it.
#define BSPC_VECTOR_STEP __attribute__((target("avx2,popcnt"), always_inline)) inline

namespace {

/// Eight states of a stream on their way through a run.
struct VectorLanes {
  __m256i states;
  __m128i greatest;
  const std::uint8_t* at;
};

BSPC_VECTOR_STEP VectorLanes vectorLanes(const RansLanes& lanes) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes.states)), _mm_setzero_si128(),
          lanes.at};
}

/// Decodes eight symbols.
BSPC_VECTOR_STEP void vectorStep(const std::uint32_t* entries, VectorLanes& lanes,
                                 std::uint8_t* symbols) {
  static_assert(kFrequencyBits == 11 && kRansLow == 1U << 15 && kMaxLanes == 8);
  const __m256i lowMask = _mm256_set1_epi32(kFrequencyTotal - 1);
  const __m256i frequencyMask = _mm256_set1_epi32(0xFFF);
  const __m256i low = _mm256_set1_epi32(kRansLow);
  // Of each 32-bit number its lowest byte, the four of a half side by side.
  const __m256i firstBytes =
      _mm256_setr_epi8(0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 4, 8, 12, -1,
                       -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
  const __m256i entry = _mm256_i32gather_epi32(reinterpret_cast<const int*>(entries),
                                               _mm256_and_si256(lanes.states, lowMask), 4);
  const __m256i frequency = _mm256_and_si256(_mm256_srli_epi32(entry, 8), frequencyMask);
  const __m256i next = _mm256_add_epi32(
      _mm256_mullo_epi32(frequency, _mm256_srli_epi32(lanes.states, kFrequencyBits)),
      _mm256_srli_epi32(entry, 20));
  const __m256i needy = _mm256_cmpgt_epi32(low, next);  // states have 31 bits
  const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(needy)));
  const __m256i words = _mm256_permutevar8x32_epi32(
      _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(lanes.at))),
      _mm256_cvtepu8_epi32(
          _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kShares[mask].data()))));
  const __m256i refilled = _mm256_or_si256(_mm256_slli_epi32(next, 16), words);
  lanes.states = _mm256_blendv_epi8(next, refilled, needy);
  lanes.at += std::size_t{2} * static_cast<unsigned>(_mm_popcnt_u32(mask));
  const __m256i bytes = _mm256_shuffle_epi8(entry, firstBytes);
  const __m128i eight =
      _mm_unpacklo_epi32(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
  lanes.greatest = _mm_max_epu8(lanes.greatest, eight);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(symbols), eight);
}

/// Gives the states back; returns the greatest symbol.
BSPC_VECTOR_STEP unsigned finishLanes(const VectorLanes& from, RansLanes& lanes) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes.states), from.states);
  lanes.at = from.at;
  __m128i greatest = from.greatest;
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 32));
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 16));
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 8));
  return static_cast<unsigned>(_mm_cvtsi128_si32(greatest)) & 0xFF;
}

}  // namespace

__attribute__((target("avx2,popcnt"))) unsigned vectorRun(const std::uint32_t* entries,
                                                          std::size_t count, RansLanes& lanes,
                                                          std::uint8_t* symbols) {
  VectorLanes run = vectorLanes(lanes);
  for (std::size_t i = 0; i < count; i += kMaxLanes) vectorStep(entries, run, symbols + i);
  return finishLanes(run, lanes);
}

__attribute__((target("avx2,popcnt"))) void vectorRuns(VectorRun& a, VectorRun& b,
                                                       std::size_t count) {
  VectorLanes runA = vectorLanes(*a.lanes);
  VectorLanes runB = vectorLanes(*b.lanes);
  for (std::size_t i = 0; i < count; i += kMaxLanes) {
    vectorStep(a.entries, runA, a.symbols + i);
    vectorStep(b.entries, runB, b.symbols + i);
  }
  a.greatest = finishLanes(runA, *a.lanes);
  b.greatest = finishLanes(runB, *b.lanes);
}

__attribute__((target("avx2,popcnt"))) void vectorRunBackward(const EncodingSymbol* table,
                                                              const std::uint8_t* end,
                                                              std::size_t count,
                                                              std::uint32_t* states,
                                                              std::uint8_t*& at) {
  static_assert(sizeof(EncodingSymbol) == 16);
  const auto* entries = reinterpret_cast<const __m128i*>(table);
  const __m256i lowHalf = _mm256_set1_epi32(0xFFFF);
  __m256i x = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(states));
  std::uint8_t* to = at;
  const std::uint8_t* symbol = end;
  for (std::size_t left = count; left > 0; left -= kMaxLanes) {
    symbol -= kMaxLanes;
    // Of lanes k and k + 4 the entries side by side, then the four numbers of all lanes together.
    __m256i pair[4];
    for (unsigned k = 0; k < 4; ++k) {
      pair[k] =
          _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(entries + symbol[k])),
                                  _mm_loadu_si128(entries + symbol[k + 4]), 1);
    }
    const __m256i low01 = _mm256_unpacklo_epi32(pair[0], pair[1]);
    const __m256i low23 = _mm256_unpacklo_epi32(pair[2], pair[3]);
    const __m256i high01 = _mm256_unpackhi_epi32(pair[0], pair[1]);
    const __m256i high23 = _mm256_unpackhi_epi32(pair[2], pair[3]);
    const __m256i most = _mm256_unpacklo_epi64(low01, low23);
    const __m256i reciprocal = _mm256_unpackhi_epi64(low01, low23);
    const __m256i bias = _mm256_unpacklo_epi64(high01, high23);
    const __m256i complementAndShift = _mm256_unpackhi_epi64(high01, high23);

    const __m256i full = _mm256_cmpgt_epi32(x, most);  // states have 31 bits
    const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(full)));
    const __m256i givers = _mm256_permutevar8x32_epi32(
        _mm256_and_si256(x, lowHalf), _mm256_cvtepu8_epi32(_mm_loadl_epi64(
                                          reinterpret_cast<const __m128i*>(kGivers[mask].data()))));
    const __m128i words =
        _mm_packus_epi32(_mm256_castsi256_si128(givers), _mm256_extracti128_si256(givers, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to - 16), words);
    to -= std::size_t{2} * static_cast<unsigned>(_mm_popcnt_u32(mask));

    const __m256i y = _mm256_blendv_epi8(x, _mm256_srli_epi32(x, 16), full);
    const __m256i even = _mm256_srli_epi64(_mm256_mul_epu32(y, reciprocal), 32);
    const __m256i odd =
        _mm256_mul_epu32(_mm256_srli_epi64(y, 32), _mm256_srli_epi64(reciprocal, 32));
    const __m256i quotient = _mm256_srlv_epi32(_mm256_blend_epi32(even, odd, 0xAA),
                                               _mm256_srli_epi32(complementAndShift, 16));
    const __m256i complement = _mm256_and_si256(complementAndShift, lowHalf);
    x = _mm256_add_epi32(_mm256_add_epi32(y, bias), _mm256_mullo_epi32(quotient, complement));
  }
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(states), x);
  at = to;
}

#else

bool hasVectorRans() { return false; }

unsigned vectorRun(const std::uint32_t*, std::size_t, RansLanes&, std::uint8_t*) {
  throw Error(ErrorCode::Unsupported, "this machine cannot decode eight symbols at once");
}

void vectorRunBackward(const EncodingSymbol*, const std::uint8_t*, std::size_t, std::uint32_t*,
                       std::uint8_t*&) {
  throw Error(ErrorCode::Unsupported, "this machine cannot encode eight symbols at once");
}

#endif

}  // namespace bspc::geometry::fast
