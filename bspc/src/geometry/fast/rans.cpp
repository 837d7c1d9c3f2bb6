#include "geometry/fast/rans.h"

#include <algorithm>
#include <memory>

#include "bspc/error.h"

namespace bspc::geometry::fast {

namespace {

EncodingSymbol encodingSymbol(std::uint32_t start, std::uint32_t frequency) {
  EncodingSymbol symbol;
  symbol.most = ((kRansLow >> kFrequencyBits) << 16) * frequency - 1;
  symbol.complement = static_cast<std::uint16_t>(kFrequencyTotal - frequency);
  if (frequency < 2) {
    symbol.reciprocal = ~std::uint32_t{0};
    symbol.bias = start + kFrequencyTotal - 1;
    return symbol;
  }
  const unsigned ceilLog2 = entropy::bitLength(frequency - 1);
  symbol.reciprocal = static_cast<std::uint32_t>(
      ((std::uint64_t{1} << (ceilLog2 + 31)) + frequency - 1) / frequency);
  symbol.bias = start;
  symbol.shift = static_cast<std::uint16_t>(ceilLog2 - 1);
  return symbol;
}

using EncodingTable = std::array<EncodingSymbol, kSymbols>;

EncodingTable encodingTable(const FrequencyTable& frequencies) {
  EncodingTable table;
  std::uint32_t start = 0;
  for (unsigned s = 0; s < kSymbols; ++s) {
    if (frequencies[s] > 0) table[s] = encodingSymbol(start, frequencies[s]);
    start += frequencies[s];
  }
  return table;
}

/// Room for words that are written from its end towards its front, and for what the eight lanes
/// overwrite before them. What is not used is never touched.
class BackwardWords {
 public:
  explicit BackwardWords(std::size_t words)
      : size_(2 * (words + kMaxLanes)), bytes_(new std::uint8_t[size_]) {}

  std::uint8_t* end() const { return bytes_.get() + size_; }

 private:
  std::size_t size_;
  std::unique_ptr<std::uint8_t[]> bytes_;
};

/// Codes a symbol; `at` is where the last word begins.
inline void encode(std::uint32_t& state, const EncodingSymbol& symbol, std::uint8_t*& at) {
  const std::uint32_t x = state;
  const bool full = x > symbol.most;
  storeLittle16(at - 2, x);
  at -= full ? 2 : 0;
  const std::uint32_t y = full ? x >> 16 : x;
  const auto quotient =
      static_cast<std::uint32_t>((std::uint64_t{y} * symbol.reciprocal) >> 32) >> symbol.shift;
  state = y + symbol.bias + quotient * symbol.complement;
}

}  // namespace

std::uint8_t* RansWriter::run(unsigned table, std::size_t count) {
  runs_.push_back(table + (static_cast<std::uint32_t>(count) << 8));
  const std::size_t at = symbols_.size();
  symbols_.resize(at + count);
  return symbols_.data() + at;
}

std::vector<SymbolCounts> RansWriter::counts(unsigned tables) const {
  std::vector<SymbolCounts> counts(tables);
  const std::uint8_t* symbol = symbols_.data();
  for (const std::uint32_t run : runs_) {
    SymbolCounts& of = counts[run & 0xFF];
    for (std::uint32_t left = run >> 8; left > 0; --left) ++of[*symbol++];
  }
  return counts;
}

Bytes RansWriter::finish(const std::vector<FrequencyTable>& tables, unsigned lanes,
                         bool vector) const {
  std::vector<EncodingTable> encoding;
  encoding.reserve(tables.size());
  for (const FrequencyTable& t : tables) encoding.push_back(encodingTable(t));
  std::array<std::uint32_t, kMaxLanes> states{};
  states.fill(kRansLow);
  const BackwardWords words(symbols_.size());
  std::uint8_t* at = words.end();
  const std::uint8_t* symbol = symbols_.data() + symbols_.size();
  for (std::size_t r = runs_.size(); r-- > 0;) {
    const EncodingTable& table = encoding[runs_[r] & 0xFF];
    std::uint32_t i = runs_[r] >> 8;
    if (lanes == kMaxLanes) {
      while (i % kMaxLanes != 0) encode(states[--i % kMaxLanes], table[*--symbol], at);
      if (vector) {
        vectorRunBackward(table.data(), symbol, i, states.data(), at);
        symbol -= i;
        i = 0;
      }
      for (; i > 0; i -= kMaxLanes) {
        symbol -= kMaxLanes;
        for (unsigned lane = kMaxLanes; lane-- > 0;) {
          encode(states[lane], table[symbol[lane]], at);
        }
      }
    } else {
      while (i > 0) encode(states[--i % lanes], table[*--symbol], at);
    }
  }
  Bytes out;
  out.reserve(std::size_t{4} * lanes + static_cast<std::size_t>(words.end() - at));
  for (unsigned lane = 0; lane < lanes; ++lane) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      out.push_back(static_cast<std::uint8_t>(states[lane] >> shift));
    }
  }
  out.insert(out.end(), at, words.end());
  return out;
}

DecodingTable::DecodingTable(const FrequencyTable& frequencies) {
  std::size_t at = 0;
  for (std::uint32_t s = 0; s < kSymbols; ++s) {
    for (std::uint32_t place = 0; place < frequencies[s]; ++place) {
      entries_[at++] = s | (frequencies[s] << 8) | (place << 20);
    }
  }
}

RansReader::RansReader(const std::uint8_t* data, std::size_t size, unsigned lanes, bool vector)
    : lanes_(lanes), vector_(vector), end_(data + size) {
  if (size < std::size_t{4} * lanes) fail();
  current_.at = data + std::size_t{4} * lanes;
  for (unsigned lane = 0; lane < lanes; ++lane) {
    current_.states[lane] = loadLittle32(data + std::size_t{4} * lane);
    if (current_.states[lane] < kRansLow || current_.states[lane] >= (kRansLow << 16)) {
      throw Error(ErrorCode::Corrupt, "an entropy coded stream starts with an impossible state");
    }
  }
}

unsigned RansReader::fullRun(const DecodingTable& table, std::size_t count, std::uint8_t* symbols) {
  // Copies of the states may live in registers.
  RansLanes lanes = current_;
  for (std::size_t i = 0; i < count; i += kMaxLanes) {
    for (unsigned lane = 0; lane < kMaxLanes; ++lane) {
      symbols[i + lane] = static_cast<std::uint8_t>(step(table, lanes.states[lane], lanes.at));
    }
  }
  current_ = lanes;
  std::uint8_t greatest = 0;
  for (std::size_t i = 0; i < count; ++i) greatest = std::max(greatest, symbols[i]);
  return greatest;
}

void RansReader::fail() {
  throw Error(ErrorCode::Corrupt,
              "an entropy coded stream ends before its last symbol: the file is damaged");
}

void RansReader::expectEnd() const {
  bool asAtStart = current_.at == end_;
  for (unsigned lane = 0; lane < lanes_; ++lane) asAtStart &= current_.states[lane] == kRansLow;
  if (!asAtStart) {
    throw Error(ErrorCode::Corrupt,
                "an entropy coded stream does not end with its last symbol: the file is damaged");
  }
}

}  // namespace bspc::geometry::fast
