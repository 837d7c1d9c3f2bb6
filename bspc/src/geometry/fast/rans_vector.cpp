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

}  // namespace

bool hasVectorRans() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

__attribute__((target("avx2,popcnt"))) unsigned vectorRun(const std::uint32_t* entries,
                                                          std::size_t count, RansLanes& lanes,
                                                          std::uint8_t* symbols) {
  static_assert(kFrequencyBits == 11 && kRansLow == 1U << 15 && kMaxLanes == 8);
  const __m256i lowMask = _mm256_set1_epi32(kFrequencyTotal - 1);
  const __m256i frequencyMask = _mm256_set1_epi32(0xFFF);
  const __m256i low = _mm256_set1_epi32(kRansLow);
  // Of each 32-bit number its lowest byte, the four of a half side by side.
  const __m256i firstBytes =
      _mm256_setr_epi8(0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 4, 8, 12, -1,
                       -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
  __m256i states = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes.states));
  __m128i greatest = _mm_setzero_si128();
  const std::uint8_t* at = lanes.at;
  for (std::size_t i = 0; i < count; i += kMaxLanes) {
    const __m256i entry = _mm256_i32gather_epi32(reinterpret_cast<const int*>(entries),
                                                 _mm256_and_si256(states, lowMask), 4);
    const __m256i frequency = _mm256_and_si256(_mm256_srli_epi32(entry, 8), frequencyMask);
    const __m256i next =
        _mm256_add_epi32(_mm256_mullo_epi32(frequency, _mm256_srli_epi32(states, kFrequencyBits)),
                         _mm256_srli_epi32(entry, 20));
    const __m256i needy = _mm256_cmpgt_epi32(low, next);  // states have 31 bits
    const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(needy)));
    const __m256i words = _mm256_permutevar8x32_epi32(
        _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(at))),
        _mm256_cvtepu8_epi32(
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kShares[mask].data()))));
    const __m256i refilled = _mm256_or_si256(_mm256_slli_epi32(next, 16), words);
    states = _mm256_blendv_epi8(next, refilled, needy);
    at += std::size_t{2} * static_cast<unsigned>(_mm_popcnt_u32(mask));
    const __m256i bytes = _mm256_shuffle_epi8(entry, firstBytes);
    const __m128i eight =
        _mm_unpacklo_epi32(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
    greatest = _mm_max_epu8(greatest, eight);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(symbols + i), eight);
  }
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(lanes.states), states);
  lanes.at = at;
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 32));
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 16));
  greatest = _mm_max_epu8(greatest, _mm_srli_epi64(greatest, 8));
  return static_cast<unsigned>(_mm_cvtsi128_si32(greatest)) & 0xFF;
}

#else

bool hasVectorRans() { return false; }

unsigned vectorRun(const std::uint32_t*, std::size_t, RansLanes&, std::uint8_t*) {
  throw Error(ErrorCode::Unsupported, "this machine cannot decode eight symbols at once");
}

#endif

}  // namespace bspc::geometry::fast
