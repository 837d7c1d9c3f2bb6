#pragma once

#include <cstddef>
#include <cstdint>

namespace bspc::geometry::fast {

/// Eight lanes of a stream, as RansReader has them.
struct RansLanes {
  std::uint32_t states[8];
  const std::uint8_t* at;
};

/// A symbol's part of the whole, prepared so that coding divides by multiplication. The 32-bit
/// reciprocal is exact for states of 31 bits. Four numbers of 32 bits, as vectors take them.
struct EncodingSymbol {
  std::uint32_t most = 0;  ///< states above give off a word first
  std::uint32_t reciprocal = 0;
  std::uint32_t bias = 0;
  std::uint16_t complement = 0;
  std::uint16_t shift = 0;
};

/// Whether this machine can code eight symbols at once.
bool hasVectorRans();

/// Decodes count / 8 times eight symbols by the entries of a DecodingTable, and returns the
/// greatest; only if hasVectorRans(). Reads up to 16 bytes past what it uses.
unsigned vectorRun(const std::uint32_t* entries, std::size_t count, RansLanes& lanes,
                   std::uint8_t* symbols);

/// A run of one of two streams.
struct VectorRun {
  const std::uint32_t* entries;
  RansLanes* lanes;
  std::uint8_t* symbols;
  unsigned greatest = 0;  ///< set by vectorRuns()
};

/// The same of two streams that have as many symbols to come: neither waits while the other's
/// states are looked up.
void vectorRuns(VectorRun& a, VectorRun& b, std::size_t count);

/// Codes the count / 8 times eight symbols that end before `end`, the last ones first, by a table
/// of all symbols; only if hasVectorRans(). Words go before `at`, which is moved back; up to 16
/// bytes before what it uses are overwritten.
void vectorRunBackward(const EncodingSymbol* table, const std::uint8_t* end, std::size_t count,
                       std::uint32_t* states, std::uint8_t*& at);

}  // namespace bspc::geometry::fast
