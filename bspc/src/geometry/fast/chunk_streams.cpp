#include "geometry/fast/chunk_streams.h"

namespace bspc::geometry::fast {

namespace {

/// Values of class c are about 2^(c / 2); the last two tables see them shifted.
DefaultTables byClass(const ValueClasses& classes, const ValueCode& code) {
  std::vector<FrequencyTable> tables;
  for (unsigned t = 0; t < classes.tables(); ++t) {
    const unsigned half = std::min(t / 2, classes.tables() / 2 - 2);
    const std::uint32_t mean = ((t & 1) != 0 ? 141U : 100U) << half;
    tables.push_back(FrequencyTable::geometric(code.direct(), t == 0 ? 20 : mean * 13 / 10));
  }
  return DefaultTables(std::move(tables));
}

}  // namespace

const DefaultTables& defaultGapTables() {
  static const DefaultTables tables = byClass(kGapClasses, kGapCode);
  return tables;
}

const DefaultTables& defaultResidualTables() {
  static const DefaultTables tables = byClass(kResidualClasses, kResidualCode);
  return tables;
}

const DefaultTables& defaultFieldTables() {
  static const DefaultTables tables({FrequencyTable::geometric(12, 560)});
  return tables;
}

TableSet::TableSet(BitReader& bits, const DefaultTables& defaults, std::size_t count) {
  tables_.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    if (bits.get(1) != 0) {
      own_.push_back(
          std::make_unique<DecodingTable>(FrequencyTable::proportionalTo(readWeights(bits))));
      tables_.push_back(own_.back().get());
    } else {
      tables_.push_back(&defaults.decoding[defaults.index(t)]);
    }
  }
}

std::vector<FrequencyTable> writeTables(BitWriter& bits, const std::vector<SymbolCounts>& counts,
                                        const DefaultTables& defaults) {
  std::vector<FrequencyTable> tables;
  tables.reserve(counts.size());
  for (std::size_t t = 0; t < counts.size(); ++t) {
    tables.push_back(defaults.frequencies[defaults.index(t)]);
    const SymbolCounts weights = storedWeights(counts[t]);
    if (weights == SymbolCounts{}) {
      bits.put(0, 1);
      continue;
    }
    const FrequencyTable own = FrequencyTable::proportionalTo(weights);
    BitWriter description;
    writeWeights(description, weights);
    const double ownCost = own.cost(counts[t]) + static_cast<double>(description.bitCount());
    const bool fitted = ownCost < tables[t].cost(counts[t]);
    bits.put(fitted ? 1 : 0, 1);
    if (!fitted) continue;
    writeWeights(bits, weights);
    tables[t] = own;
  }
  return tables;
}

}  // namespace bspc::geometry::fast
