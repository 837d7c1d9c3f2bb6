#include "geometry/fast/chunk_streams.h"

#include <algorithm>
#include <utility>

namespace bspc::geometry::fast {

std::vector<FrequencyTable> defaultTables(const ValueClasses& classes, const ValueCode& code) {
  std::vector<FrequencyTable> tables;
  for (unsigned t = 0; t < classes.tables(); ++t) {
    // Values of class c are about 2^(c / 2); the last two tables see them shifted.
    const unsigned half = std::min(t / 2, classes.tables() / 2 - 2);
    const std::uint32_t mean = ((t & 1) != 0 ? 141U : 100U) << half;
    tables.push_back(FrequencyTable::geometric(code.direct(), t == 0 ? 20 : mean * 13 / 10));
  }
  return tables;
}

std::vector<FrequencyTable> defaultFieldTables(unsigned count) {
  return std::vector<FrequencyTable>(count, FrequencyTable::geometric(12, 560));
}

std::vector<FrequencyTable> writeTables(BitWriter& bits, const std::vector<SymbolCounts>& counts,
                                        std::vector<FrequencyTable> tables) {
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const SymbolCounts weights = storedWeights(counts[t]);
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

std::vector<DecodingTable> readTables(BitReader& bits,
                                      const std::vector<FrequencyTable>& defaults) {
  std::vector<DecodingTable> tables;
  tables.reserve(defaults.size());
  for (const FrequencyTable& assumed : defaults) {
    tables.emplace_back(bits.get(1) != 0 ? FrequencyTable::proportionalTo(readWeights(bits))
                                         : assumed);
  }
  return tables;
}

}  // namespace bspc::geometry::fast
