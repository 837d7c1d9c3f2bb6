#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "geometry/fast/frequency_table.h"
#include "geometry/fast/little_endian.h"
#include "geometry/fast/rans_vector.h"

namespace bspc::geometry::fast {

// Range asymmetric numeral systems (Duda 2013) with static tables: a state of 31 bits, words of 16
// bits, several interleaved states ("lanes") for speed. The encoder runs backwards, so symbols are
// gathered first.

constexpr unsigned kMaxLanes = 8;
constexpr std::uint32_t kRansLow = 1U << 15;  ///< states lie in kRansLow … 2^16 kRansLow − 1

/// Lanes of a stream of `symbols` symbols: a lane costs two bytes.
constexpr unsigned ransLanes(std::uint64_t symbols) { return symbols < 4096 ? 1 : kMaxLanes; }

/// Symbols to be coded, in runs that share a table. The lane of a symbol is its place in the run
/// modulo the number of lanes.
class RansWriter {
 public:
  explicit RansWriter(std::size_t expected = 0) { symbols_.reserve(expected); }

  /// Appends a run of `count` < 2^24 symbols, to be filled in.
  std::uint8_t* run(unsigned table, std::size_t count);
  void symbol(unsigned table, unsigned symbol) {
    runs_.push_back(table + (1U << 8));
    symbols_.push_back(static_cast<std::uint8_t>(symbol));
  }
  bool empty() const { return symbols_.empty(); }

  /// counts[t]: the symbols of table t.
  std::vector<SymbolCounts> counts(unsigned tables) const;
  /// `vector`: eight symbols at once, with the same result.
  Bytes finish(const std::vector<FrequencyTable>& tables, unsigned lanes,
               bool vector = hasVectorRans()) const;

 private:
  std::vector<std::uint8_t> symbols_;
  std::vector<std::uint32_t> runs_;  ///< table + 256 · count
};

/// For each value of a state's low bits: symbol, frequency and place inside the symbol's part.
class DecodingTable {
 public:
  DecodingTable() = default;
  explicit DecodingTable(const FrequencyTable& frequencies);
  std::uint32_t entry(std::uint32_t state) const { return entries_[state & (kFrequencyTotal - 1)]; }
  const std::uint32_t* entries() const { return entries_.data(); }

  static std::uint32_t symbolOf(std::uint32_t entry) { return entry & 0xFF; }
  static std::uint32_t frequencyOf(std::uint32_t entry) { return (entry >> 8) & 0xFFF; }
  static std::uint32_t placeOf(std::uint32_t entry) { return entry >> 20; }

 private:
  std::array<std::uint32_t, kFrequencyTotal> entries_{};
};

/// A run of a stream to be decoded: count ≤ 48 symbols.
struct RansRun {
  const DecodingTable& table;
  std::size_t count;
  std::uint8_t* symbols;
  unsigned greatest = 0;  ///< of the symbols
};

/// Decodes what RansWriter coded. kSectionPadding bytes behind the section must be readable.
class RansReader {
 public:
  RansReader() = default;
  /// `vector`: eight symbols at once, with the same result.
  RansReader(const std::uint8_t* data, std::size_t size, unsigned lanes,
             bool vector = hasVectorRans());

  /// Decodes a run of count ≤ 48 symbols; returns the greatest. Throws Error(Corrupt) past the end.
  unsigned run(const DecodingTable& table, std::size_t count, std::uint8_t* symbols) {
    RansRun run{table, count, symbols};
    finishRun(run, 0);
    return run.greatest;
  }
  /// The same of a run of each of two streams, which takes less time than one after the other.
  static void runBoth(RansReader& a, RansRun& runA, RansReader& b, RansRun& runB) {
    std::size_t together = 0;
    if (a.inVectors() && b.inVectors()) {
      together = std::min(runA.count, runB.count) / kMaxLanes * kMaxLanes;
      VectorRun vectorA{runA.table.entries(), &a.current_, runA.symbols};
      VectorRun vectorB{runB.table.entries(), &b.current_, runB.symbols};
      vectorRuns(vectorA, vectorB, together);
      runA.greatest = vectorA.greatest;
      runB.greatest = vectorB.greatest;
    }
    a.finishRun(runA, together);
    b.finishRun(runB, together);
  }
  unsigned symbol(const DecodingTable& table) {
    const unsigned symbol = step(table, current_.states[0], current_.at);
    if (current_.at > end_) fail();
    return symbol;
  }

  /// Throws Error(Corrupt) unless the stream was used up and the states are those of its start.
  void expectEnd() const;

 private:
  static unsigned step(const DecodingTable& table, std::uint32_t& state, const std::uint8_t*& at) {
    const std::uint32_t entry = table.entry(state);
    const std::uint32_t next = DecodingTable::frequencyOf(entry) * (state >> kFrequencyBits) +
                               DecodingTable::placeOf(entry);
    const std::uint32_t refilled = (next << 16) | loadLittle16(at);
    const bool refill = next < kRansLow;
    state = refill ? refilled : next;
    at += refill ? 2 : 0;
    return DecodingTable::symbolOf(entry);
  }
  bool inVectors() const { return vector_ && lanes_ == kMaxLanes; }

  /// Of a run `done` symbols are there, a multiple of the lanes, and the greatest of them.
  void finishRun(RansRun& run, std::size_t done) {
    if (lanes_ == kMaxLanes && run.count - done >= kMaxLanes) {
      const std::size_t full = (run.count - done) / kMaxLanes * kMaxLanes;
      std::uint8_t* symbols = run.symbols + done;
      const unsigned greatest = vector_ ? vectorRun(run.table.entries(), full, current_, symbols)
                                        : fullRun(run.table, full, symbols);
      run.greatest = std::max(run.greatest, greatest);
      done += full;
    }
    // What is left starts again at the first lane.
    for (; done < run.count; ++done) {
      const unsigned symbol = step(run.table, current_.states[done & (lanes_ - 1)], current_.at);
      run.symbols[done] = static_cast<std::uint8_t>(symbol);
      run.greatest = std::max(run.greatest, symbol);
    }
    if (current_.at > end_) fail();
  }
  unsigned fullRun(const DecodingTable& table, std::size_t count, std::uint8_t* symbols);
  [[noreturn]] static void fail();

  RansLanes current_{};
  unsigned lanes_ = 1;  ///< a power of two
  bool vector_ = false;
  const std::uint8_t* end_ = nullptr;
};

}  // namespace bspc::geometry::fast
