#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "geometry/fast/bit_stream.h"
#include "geometry/fast/rans.h"
#include "geometry/fast/surface_model.h"
#include "geometry/fast/value_code.h"

namespace bspc::geometry::fast {

/// What is told once a chunk; each has a frequency table of its own.
enum Field : unsigned {
  kGapClass,
  kMode,
  kResidualClass,
  kHeight,
  kSlopeU,
  kSlopeV,
  kBendUU,
  kBendUV,
  kBendVV,
  kConstantHeight,
  kFields
};

/// Tables that are assumed of a stream unless a tile brings its own; made once. Tables past the
/// last are like it.
struct DefaultTables {
  std::vector<FrequencyTable> frequencies;
  std::vector<DecodingTable> decoding;

  explicit DefaultTables(std::vector<FrequencyTable> tables)
      : frequencies(std::move(tables)), decoding(frequencies.begin(), frequencies.end()) {}
  std::size_t index(std::size_t table) const { return std::min(table, frequencies.size() - 1); }
};
const DefaultTables& defaultGapTables();
const DefaultTables& defaultResidualTables();
const DefaultTables& defaultFieldTables();

/// The tables of a stream that is decoded.
class TableSet {
 public:
  TableSet() = default;
  /// Reads what writeTables() wrote.
  TableSet(BitReader& bits, const DefaultTables& defaults, std::size_t count);
  const DecodingTable& operator[](std::size_t table) const { return *tables_[table]; }

 private:
  std::vector<const DecodingTable*> tables_;
  std::vector<std::unique_ptr<DecodingTable>> own_;
};

/// Chooses for each table between the default and one fitted to the counts, and writes the choice.
std::vector<FrequencyTable> writeTables(BitWriter& bits, const std::vector<SymbolCounts>& counts,
                                        const DefaultTables& defaults);

/// Where chunks are written to. ChunkReader (chunk_reader.h) has the same shape, so that one
/// description (chunk_coder.h) serves both.
struct ChunkWriter {
  static constexpr bool kWriting = true;

  RansWriter gaps;
  RansWriter residuals;
  RansWriter fields;
  BitWriter raw;

  explicit ChunkWriter(std::size_t points) : gaps(points), residuals(points) {}

  std::uint64_t field(Field which, std::uint64_t value) {
    const unsigned symbol = kFieldCode.symbolOf(value);
    fields.symbol(which, symbol);
    const unsigned extra = kFieldCode.extraBits(symbol);
    if (extra > 0) raw.put(value - kFieldCode.base(symbol), extra);
    return value;
  }
  template <class T>
  void gapValues(unsigned cls, T* values, std::size_t count) {
    this->values(gaps, kGapCode, kGapClasses, cls, values, count);
  }
  template <class T>
  void residualValues(unsigned cls, T* values, std::size_t count) {
    this->values(residuals, kResidualCode, kResidualClasses, cls, values, count);
  }
  std::uint64_t rawField(std::uint64_t value, unsigned width) { return raw.code(value, width); }

 private:
  template <class T>
  void values(RansWriter& stream, const ValueCode& code, const ValueClasses& classes, unsigned cls,
              const T* values, std::size_t count) {
    const unsigned shift = classes.shift(cls);
    std::uint8_t* symbols = stream.run(classes.table(cls), count);
    std::uint64_t all = 0;
    bool direct = true;
    for (std::size_t i = 0; i < count; ++i) {
      all = std::uint64_t{values[i]} >> shift;
      direct &= all < code.direct();
      symbols[i] = static_cast<std::uint8_t>(all);
    }
    if (direct) {
      raw.putLowBits(values, count, shift);
      return;
    }
    raw.putEach(count, [&](std::size_t i, unsigned& width) {
      const unsigned symbol = code.symbolOf(std::uint64_t{values[i]} >> shift);
      symbols[i] = static_cast<std::uint8_t>(symbol);
      width = shift + code.extraBits(symbol);
      return values[i] - (code.base(symbol) << shift);
    });
  }
};

}  // namespace bspc::geometry::fast
