#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bspc/error.h"
#include "geometry/fast/chunk_streams.h"

namespace bspc::geometry::fast {

/// Where chunks are read from. Symbols of the gaps of the next chunk are decoded together with
/// those of the residuals of the present one, because the states of a single stream come too
/// slowly one after the other; bits in the raw section keep their order.
struct ChunkReader {
  static constexpr bool kWriting = false;

  RansReader gaps;
  RansReader residuals;
  RansReader fields;
  BitReader raw;
  TableSet gapTables;
  TableSet residualTables;
  TableSet fieldTables;

  std::uint64_t field(Field which, std::uint64_t /*value*/) {
    const unsigned symbol = which == kGapClass ? gapClassSymbol() : fieldSymbol(which);
    const unsigned extra = kFieldCode.extraBits(symbol);
    return kFieldCode.base(symbol) + (extra > 0 ? raw.get(extra) : 0);
  }

  /// Says before the residuals of a chunk are read that after it come gaps of so many points.
  void announceGaps(std::size_t count) { ahead_.count = count; }

  template <class T>
  void gapValues(unsigned cls, T* values, std::size_t count) {
    gapClass_ = cls;
    if (ahead_.decoded) {
      ahead_.decoded = false;
    } else {
      ahead_.greatest = gaps.run(gapTables[kGapClasses.table(cls)], count, ahead_.symbols.data());
    }
    this->values(ahead_.symbols.data(), ahead_.greatest, kGapCode, kGapClasses.shift(cls), values,
                 count);
  }
  template <class T>
  void residualValues(unsigned cls, T* values, std::size_t count) {
    std::array<std::uint8_t, kChunkPoints> symbols;
    const DecodingTable& table = residualTables[kResidualClasses.table(cls)];
    const DecodingTable* gapTable = nextGapTable();
    unsigned greatest = 0;
    if (gapTable != nullptr) {
      RansRun residualRun{table, count, symbols.data()};
      RansRun gapRun{*gapTable, ahead_.count, ahead_.symbols.data()};
      RansReader::runBoth(residuals, residualRun, gaps, gapRun);
      greatest = residualRun.greatest;
      ahead_.greatest = gapRun.greatest;
      ahead_.decoded = true;
    } else {
      greatest = residuals.run(table, count, symbols.data());
    }
    ahead_.count = 0;
    this->values(symbols.data(), greatest, kResidualCode, kResidualClasses.shift(cls), values,
                 count);
  }
  std::uint64_t rawField(std::uint64_t value, unsigned width) { return raw.code(value, width); }

  void expectEnd(bool withGaps) {
    if (withGaps) gaps.expectEnd();
    residuals.expectEnd();
    fields.expectEnd();
    raw.expectEnd();
  }

 private:
  /// What is known of the next chunk.
  struct Ahead {
    static constexpr unsigned kNone = ~0U;

    unsigned classSymbol = kNone;  ///< of the field kGapClass
    std::size_t count = 0;         ///< points, 0 if there is no such chunk
    bool decoded = false;          ///< the symbols of its gaps
    unsigned greatest = 0;
    std::array<std::uint8_t, kChunkPoints> symbols;
  };

  unsigned fieldSymbol(Field which) { return fields.symbol(fieldTables[which]); }

  unsigned gapClassSymbol() {
    if (ahead_.classSymbol == Ahead::kNone) return fieldSymbol(kGapClass);
    const unsigned symbol = ahead_.classSymbol;
    ahead_.classSymbol = Ahead::kNone;
    return symbol;
  }

  /// The table of the announced gaps; null if there are none, or if their class takes raw bits,
  /// whose turn is not yet.
  const DecodingTable* nextGapTable() {
    if (ahead_.count == 0) return nullptr;
    ahead_.classSymbol = fieldSymbol(kGapClass);
    if (kFieldCode.extraBits(ahead_.classSymbol) > 0) return nullptr;
    const std::int64_t cls = gapClass_ + unzigzag(kFieldCode.base(ahead_.classSymbol));
    if (cls < 0 || cls > kGapClasses.last()) return nullptr;
    return &gapTables[kGapClasses.table(static_cast<unsigned>(cls))];
  }

  template <class T>
  void values(const std::uint8_t* symbols, unsigned greatest, const ValueCode& code, unsigned shift,
              T* values, std::size_t count) {
    if (greatest < code.direct()) {
      if (shift == 0) {
        for (std::size_t i = 0; i < count; ++i) values[i] = symbols[i];
        return;
      }
      const std::size_t from = raw.advance(count * shift);
      const BitReader bits = raw;  // copies live in registers
      for (std::size_t i = 0; i < count; ++i) {
        values[i] =
            static_cast<T>((std::uint64_t{symbols[i]} << shift) | bits.at(from + i * shift, shift));
      }
      return;
    }
    if (shift + code.extraBits(greatest) > kMaxFieldBits) {
      throw Error(ErrorCode::Corrupt, "a value has more bits than any coordinate");
    }
    static_assert((kChunkPoints * kMaxFieldBits + 7) / 8 + 8 <= kSectionPadding);
    const BitReader bits = raw;
    const std::size_t from = bits.position();
    std::size_t at = from;
    for (std::size_t i = 0; i < count; ++i) {
      const unsigned width = shift + code.extraBits(symbols[i]);
      values[i] = static_cast<T>((code.base(symbols[i]) << shift) + bits.at(at, width));
      at += width;
    }
    raw.advance(at - from);
  }

  unsigned gapClass_ = 0;  ///< of the gaps before
  Ahead ahead_{};
};

}  // namespace bspc::geometry::fast
