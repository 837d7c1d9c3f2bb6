#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "bspc/error.h"
#include "entropy/symbol_coder.h"

namespace bspc::entropy {
namespace {

/// Codes the same random mixture of symbols with either coder; the writer's values come from
/// `random`, the reader's are checked against it.
class Mixture {
 public:
  explicit Mixture(std::uint64_t seed, unsigned bias) : random_(seed), bias_(bias) {}

  template <class Coder>
  void step(Coder& coder, std::size_t i) {
    const bool rare = random_() % bias_ == 0;
    expect(coder.bit(bit_, rare), rare, i);
    const auto symbol = static_cast<unsigned>(random_() % 16);
    expect(coder.symbol(symbols_, symbol), symbol, i);
    const auto last = static_cast<std::uint32_t>(random_() >> (random_() % 33 + 31));
    const auto value = static_cast<std::uint32_t>(random_() % (std::uint64_t{last} + 1));
    expect(coder.uniform(value, last), value, i);
    const auto width = static_cast<unsigned>(random_() % 65);
    const std::uint64_t wide = width == 0 ? 0 : random_() >> (64 - width);
    expect(coder.wide(wide, width), wide, i);
    const auto one = static_cast<std::uint32_t>(1 + random_() % 65535);
    const bool fixed = random_() % 65536 < one;
    expect(coder.fixedBit(one, fixed), fixed, i);
  }

 private:
  template <class T>
  void expect(T got, T wanted, std::size_t i) {
    ASSERT_EQ(got, wanted) << "symbol group " << i;
  }

  std::mt19937_64 random_;
  unsigned bias_;
  AdaptiveBit bit_;
  AdaptiveSymbols<16> symbols_;
};

TEST(RangeCoder, ReturnsEverySymbolOfAMixture) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const unsigned bias = seed % 3 == 0 ? 2 : 200;
    const std::size_t count = seed * seed;
    SymbolWriter writer;
    Mixture written(seed, bias);
    for (std::size_t i = 0; i < count; ++i) written.step(writer, i);
    const Bytes bytes = writer.finish();
    SymbolReader reader(bytes);
    Mixture read(seed, bias);
    for (std::size_t i = 0; i < count; ++i) read.step(reader, i);
    EXPECT_NO_THROW(reader.finish());
  }
}

TEST(RangeCoder, CarriesRunThroughLongRowsOfOnes) {
  // Bits that are coded at the very top of the range push low towards a carry again and again.
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<std::uint32_t> values;
    for (unsigned i = 0; i < 200; ++i) {
      values.push_back(random() % 8 == 0 ? static_cast<std::uint32_t>(random() & 0xFFFF) : 0xFFFFU);
    }
    SymbolWriter writer;
    for (const std::uint32_t v : values) writer.slice(v, 65536);
    for (const std::uint32_t v : values) writer.fixedBit(65535, (v & 1) != 0);
    const Bytes bytes = writer.finish();
    SymbolReader reader(bytes);
    for (const std::uint32_t v : values) ASSERT_EQ(reader.slice(0, 65536), v);
    for (const std::uint32_t v : values) ASSERT_EQ(reader.fixedBit(65535, false), (v & 1) != 0);
    EXPECT_NO_THROW(reader.finish());
  }
}

TEST(RangeCoder, AnEmptyStreamTakesNoBytes) { EXPECT_TRUE(SymbolWriter().finish().empty()); }

TEST(RangeCoder, SpendsAboutTheEntropyOfASkewedBit) {
  SymbolWriter writer;
  AdaptiveBit model;
  std::mt19937_64 random(1);
  for (unsigned i = 0; i < 80000; ++i) writer.bit(model, random() % 50 == 0);
  // H(1/50) = 0.1414 bits.
  EXPECT_LT(static_cast<double>(writer.finish().size()) * 8 / 80000, 0.1414 * 1.03);
}

TEST(RangeCoder, ReadingOnPastTheEndIsAnError) {
  SymbolWriter writer;
  writer.wide(0x123456789ABCDEF, 60);
  const Bytes bytes = writer.finish();
  SymbolReader reader(bytes);
  EXPECT_THROW(
      {
        for (unsigned i = 0; i < 64; ++i) reader.wide(0, 64);
      },
      Error);
}

TEST(RangeCoder, BytesLeftOverAreAnError) {
  SymbolWriter writer;
  for (unsigned i = 0; i < 100; ++i) writer.wide(i, 30);
  const Bytes bytes = writer.finish();
  SymbolReader reader(bytes);
  reader.wide(0, 30);
  EXPECT_THROW(reader.finish(), Error);
}

TEST(RangeCoder, AnyBytesGiveValuesInRange) {
  std::mt19937_64 random(5);
  for (unsigned trial = 0; trial < 200; ++trial) {
    Bytes bytes(1 + random() % 200);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    SymbolReader reader(bytes);
    AdaptiveSymbols<16> symbols;
    AdaptiveBit bit;
    try {
      for (unsigned i = 0; i < 1000; ++i) {
        const auto last = static_cast<std::uint32_t>(random() >> 33);
        ASSERT_LE(reader.uniform(0, last), last);
        ASSERT_LT(reader.symbol(symbols, 0), 16U);
        reader.bit(bit, false);
        ASSERT_LT(reader.wide(0, 20), 1U << 20);
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Corrupt);
    }
  }
}

}  // namespace
}  // namespace bspc::entropy
