#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/fast/chunk_streams.h"
#include "geometry/fast/rans.h"

namespace bspc::geometry::fast {
namespace {

Bytes padded(Bytes bytes) {
  bytes.resize(bytes.size() + kSectionPadding);
  return bytes;
}

std::uint32_t total(const FrequencyTable& table) {
  std::uint32_t sum = 0;
  for (unsigned s = 0; s < kSymbols; ++s) sum += table[s];
  return sum;
}

SymbolCounts skewedCounts(std::uint64_t seed, unsigned symbols) {
  std::mt19937_64 random(seed);
  SymbolCounts counts{};
  for (unsigned s = 0; s < symbols; ++s) {
    counts[s] = static_cast<std::uint32_t>(random() % (1U << (random() % 20)));
  }
  counts[0] = 1;
  return counts;
}

TEST(BitStream, GivesBackFieldsOfEveryWidth) {
  std::mt19937_64 random(1);
  BitWriter writer;
  std::vector<std::pair<std::uint64_t, unsigned>> fields;
  for (unsigned i = 0; i < 5000; ++i) {
    const unsigned width = i % (kMaxFieldBits + 1);
    fields.emplace_back(random() & lowBits(width), width);
    writer.put(fields.back().first, width);
  }
  const Bytes bytes = writer.finish();
  const Bytes readable = padded(bytes);
  BitReader reader(readable.data(), bytes.size());
  for (const auto& [value, width] : fields) ASSERT_EQ(reader.get(width), value);
  EXPECT_NO_THROW(reader.expectEnd());
  EXPECT_THROW(reader.get(8), Error);
}

TEST(BitStream, RefusesWhatIsLeftOver) {
  const Bytes readable = padded({0x01, 0x00});
  BitReader early(readable.data(), 2);
  early.get(3);
  EXPECT_THROW(early.expectEnd(), Error);
  BitReader dirty(readable.data(), 1);
  EXPECT_THROW(dirty.expectEnd(), Error);
}

TEST(ValueCode, SymbolAndExtraBitsTellEveryValue) {
  for (const ValueCode* code : {&kGapCode, &kResidualCode, &kFieldCode, &kStepCode}) {
    std::uint64_t next = 0;
    for (unsigned s = 0; s < kSymbols && code->extraBits(s) < 40; ++s) {
      EXPECT_EQ(code->base(s), next);
      EXPECT_EQ(code->symbolOf(next), s);
      next += std::uint64_t{1} << code->extraBits(s);
      EXPECT_EQ(code->symbolOf(next - 1), s);
    }
  }
}

TEST(ValueCode, ZigzagFoldsSigns) {
  EXPECT_EQ(zigzag(0), 0U);
  EXPECT_EQ(zigzag(-1), 1U);
  EXPECT_EQ(zigzag(1), 2U);
  EXPECT_EQ(zigzag32(0U - 3U), 5U);
  for (const std::int64_t v : {std::int64_t{0}, std::int64_t{-5}, INT64_MAX, INT64_MIN}) {
    EXPECT_EQ(unzigzag(zigzag(v)), v);
  }
  for (const std::uint32_t v : {0U, 1U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    EXPECT_EQ(unzigzag32(zigzag32(v)), v);
  }
}

TEST(FrequencyTable, AddsUpAndKeepsEverySymbol) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const SymbolCounts counts = skewedCounts(seed, 1 + static_cast<unsigned>(seed) % kSymbols);
    const FrequencyTable table = FrequencyTable::proportionalTo(counts);
    ASSERT_EQ(total(table), kFrequencyTotal);
    for (unsigned s = 0; s < kSymbols; ++s) ASSERT_EQ(table[s] > 0, counts[s] > 0);
  }
  EXPECT_EQ(FrequencyTable::proportionalTo({})[0], kFrequencyTotal);
  EXPECT_EQ(total(FrequencyTable::geometric(24, 130)), kFrequencyTotal);
}

TEST(FrequencyTable, SurvivesBeingWritten) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const SymbolCounts weights =
        storedWeights(skewedCounts(seed, 1 + static_cast<unsigned>(seed) % kSymbols));
    BitWriter writer;
    writeWeights(writer, weights);
    const Bytes bytes = writer.finish();
    const Bytes readable = padded(bytes);
    BitReader reader(readable.data(), bytes.size());
    ASSERT_EQ(readWeights(reader), weights);
    ASSERT_NO_THROW(reader.expectEnd());
  }
}

TEST(FrequencyTable, RefusesImpossibleWeights) {
  BitWriter writer;
  writer.put(0, 7);
  writer.put(lowBits(16), 17);  // eight bits longer than the first guess of six
  const Bytes bytes = writer.finish();
  const Bytes readable = padded(bytes);
  BitReader reader(readable.data(), bytes.size());
  EXPECT_THROW(readWeights(reader), Error);
}

/// Tables that are as skewed as can be.
std::vector<FrequencyTable> skewedTables() {
  SymbolCounts rare{};
  rare[3] = 1;
  rare[100] = 1U << 30;
  SymbolCounts single{};
  single[127] = 1;
  return {FrequencyTable::proportionalTo(skewedCounts(1, kSymbols)),
          FrequencyTable::proportionalTo(rare), FrequencyTable::proportionalTo(single),
          FrequencyTable::geometric(32, 1000)};
}

/// Runs of random lengths over tables.
struct Runs {
  std::vector<std::pair<unsigned, Bytes>> runs;  ///< table, symbols
  RansWriter writer;

  Runs(std::uint64_t seed, const std::vector<FrequencyTable>& tables) {
    std::mt19937_64 random(seed);
    for (unsigned i = 0; i < 3000; ++i) {
      const auto t = static_cast<unsigned>(random() % tables.size());
      Bytes run(random() % 3 == 0 ? kChunkPoints : random() % (kChunkPoints + 1));
      for (std::uint8_t& s : run) {
        do {
          s = static_cast<std::uint8_t>(random() % kSymbols);
        } while (tables[t][s] == 0);
      }
      std::copy(run.begin(), run.end(), writer.run(t, run.size()));
      runs.emplace_back(t, run);
    }
  }
};

unsigned greatestOf(const Bytes& run) {
  return run.empty() ? 0 : *std::max_element(run.begin(), run.end());
}

class RansStream : public testing::TestWithParam<unsigned> {};

TEST_P(RansStream, RoundTripAndEnd) {
  const std::vector<FrequencyTable> tables = skewedTables();
  const Runs coded(7, tables);
  const Bytes bytes = coded.writer.finish(tables, GetParam(), false);
  EXPECT_EQ(coded.writer.finish(tables, GetParam(), hasVectorRans()), bytes);
  const Bytes readable = padded(bytes);
  std::vector<DecodingTable> decoding(tables.begin(), tables.end());
  for (const bool vector : {false, hasVectorRans()}) {
    RansReader reader(readable.data(), bytes.size(), GetParam(), vector);
    for (const auto& [t, run] : coded.runs) {
      std::uint8_t symbols[64];
      const unsigned greatest = reader.run(decoding[t], run.size(), symbols);
      ASSERT_EQ(Bytes(symbols, symbols + run.size()), run);
      ASSERT_EQ(greatest, greatestOf(run));
    }
    EXPECT_NO_THROW(reader.expectEnd());
  }
}

TEST_P(RansStream, TwoStreamsAtOnceGiveTheSame) {
  const std::vector<FrequencyTable> tables = skewedTables();
  const Runs codedA(8, tables);
  const Runs codedB(9, tables);
  const Bytes bytesA = codedA.writer.finish(tables, GetParam());
  const Bytes bytesB = codedB.writer.finish(tables, 8);
  const Bytes readableA = padded(bytesA);
  const Bytes readableB = padded(bytesB);
  std::vector<DecodingTable> decoding(tables.begin(), tables.end());
  for (const bool vector : {false, hasVectorRans()}) {
    RansReader a(readableA.data(), bytesA.size(), GetParam(), vector);
    RansReader b(readableB.data(), bytesB.size(), 8, vector);
    for (std::size_t i = 0; i < codedA.runs.size(); ++i) {
      const auto& [tableA, symbolsA] = codedA.runs[i];
      const auto& [tableB, symbolsB] = codedB.runs[i];
      Bytes backA(64);
      Bytes backB(64);
      RansRun runA{decoding[tableA], symbolsA.size(), backA.data()};
      RansRun runB{decoding[tableB], symbolsB.size(), backB.data()};
      RansReader::runBoth(a, runA, b, runB);
      backA.resize(symbolsA.size());
      backB.resize(symbolsB.size());
      ASSERT_EQ(backA, symbolsA);
      ASSERT_EQ(backB, symbolsB);
      ASSERT_EQ(runA.greatest, greatestOf(symbolsA));
      ASSERT_EQ(runB.greatest, greatestOf(symbolsB));
    }
    EXPECT_NO_THROW(a.expectEnd());
    EXPECT_NO_THROW(b.expectEnd());
    if (GetParam() == 8) {
      RansReader shortened(readableA.data(), bytesA.size() - 20, 8, vector);
      RansReader whole(readableB.data(), bytesB.size(), 8, vector);
      const auto readAll = [&] {
        for (std::size_t i = 0; i < codedA.runs.size(); ++i) {
          std::uint8_t symbols[2][64];
          RansRun runA{decoding[codedA.runs[i].first], codedA.runs[i].second.size(), symbols[0]};
          RansRun runB{decoding[codedB.runs[i].first], codedB.runs[i].second.size(), symbols[1]};
          RansReader::runBoth(shortened, runA, whole, runB);
        }
      };
      EXPECT_THROW(readAll(), Error);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fast, RansStream, testing::Values(1U, 8U));

TEST(Rans, ComesCloseToTheEntropy) {
  std::mt19937_64 random(8);
  RansWriter writer;
  for (unsigned i = 0; i < 100000; ++i) {
    writer.symbol(0, static_cast<unsigned>(__builtin_ctzll(random() | (1ULL << 20))));
  }
  const std::vector<SymbolCounts> counts = writer.counts(1);
  const FrequencyTable table = FrequencyTable::proportionalTo(counts[0]);
  const double bits = 8.0 * static_cast<double>(writer.finish({table}, 8).size());
  EXPECT_LT(bits, table.cost(counts[0]) * 1.005 + 300);
  EXPECT_NEAR(bits, 200000, 2500);  // two bits a symbol
}

TEST(Rans, RefusesBadStartsAndEnds) {
  const std::vector<FrequencyTable> tables{FrequencyTable::geometric(24, 300)};
  RansWriter writer;
  for (unsigned i = 0; i < 100; ++i) writer.symbol(0, i % 20);
  const Bytes bytes = writer.finish(tables, 1);
  const DecodingTable table(tables[0]);
  const Bytes readable = padded(bytes);
  EXPECT_THROW(RansReader(readable.data(), 3, 1), Error);
  const Bytes zeros(kSectionPadding + 4);
  EXPECT_THROW(RansReader(zeros.data(), 4, 1), Error);
  RansReader early(readable.data(), bytes.size(), 1);
  early.symbol(table);
  EXPECT_THROW(early.expectEnd(), Error);
  RansReader shortened(readable.data(), bytes.size() - 20, 1);
  const auto readAll = [&] {
    for (unsigned i = 0; i < 100; ++i) shortened.symbol(table);
  };
  EXPECT_THROW(readAll(), Error);
}

TEST(Tables, AreWrittenOnlyWhereTheyPay) {
  std::vector<SymbolCounts> counts(2);
  counts[0][0] = 3;      // too few to describe
  counts[1][90] = 5000;  // what no default expects
  const DefaultTables& defaults = defaultFieldTables();
  BitWriter writer;
  const std::vector<FrequencyTable> chosen = writeTables(writer, counts, defaults);
  EXPECT_EQ(chosen[0][1], defaults.frequencies[0][1]);
  EXPECT_EQ(chosen[1][90], kFrequencyTotal);
  const Bytes bytes = writer.finish();
  const Bytes readable = padded(bytes);
  BitReader reader(readable.data(), bytes.size());
  const TableSet read(reader, defaults, 2);
  EXPECT_EQ(DecodingTable::symbolOf(read[1].entry(77)), 90U);
  EXPECT_NO_THROW(reader.expectEnd());
}

}  // namespace
}  // namespace bspc::geometry::fast
