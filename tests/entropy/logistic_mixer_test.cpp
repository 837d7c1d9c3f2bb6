#include "entropy/logistic_mixer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "entropy/symbol_coder.h"

namespace bspc::entropy {
namespace {

TEST(LogisticMath, ComesCloseToTheRealFunctions) {
  for (int i = -80; i < 80; ++i) {
    const float x = static_cast<float>(i) * 0.37F;
    EXPECT_NEAR(exp2(x) / std::exp2(x), 1, 1e-3) << x;
    EXPECT_NEAR(naturalLog(std::exp2(x)), x * std::log(2.0F), 1e-3) << x;
    EXPECT_NEAR(squash(x), 1 / (1 + std::exp(-x)), 1e-3) << x;
  }
  for (unsigned i = 0; i < kStretch.size(); i += 7) {
    EXPECT_NEAR(squash(kStretch[i]), (static_cast<float>(i) + 0.5F) / 4096, 1e-3) << i;
  }
  EXPECT_FLOAT_EQ(kStretch[0], static_cast<float>(std::log(0.5 / 4095.5)));
  EXPECT_FLOAT_EQ(kStretch[4095], static_cast<float>(std::log(4095.5 / 0.5)));
}

// What files depend on: these very bits, whatever the compiler.
TEST(LogisticMath, GivesTheSameBitsEverywhere) {
  EXPECT_EQ(bitsOf(naturalLog(3.7F)), 0x3FA78481U);
  EXPECT_EQ(bitsOf(exp2(-1.3F)), 0x3ECFEF24U);
  EXPECT_EQ(bitsOf(squash(0.8F)), 0x3F30A2A5U);
  EXPECT_EQ(bitsOf(kStretch[1000]), 0xBF9091CEU);
  EXPECT_EQ(bitsOf(bell(-0.6F)), 0xBEFAC688U);
}

TEST(LogisticMath, KeepsNonsenseWithinItsBounds) {
  const float nan = std::nanf("");
  EXPECT_EQ(clamped(nan, -8, 8), -8);
  EXPECT_EQ(classOf(nan, 1, 0, 9), 0U);
  EXPECT_EQ(classOf(1e30F, 1, 0, 9), 8U);
  EXPECT_GT(squash(-1e30F), 0);
  EXPECT_LE(squash(1e30F), 1);
}

TEST(Lanes, DoEachWhatOneNumberDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.01F, 50);
  float values[kLanes];
  for (float& v : values) v = uniform(random);
  const Lanes lanes = load(values);
  const Lanes logs = naturalLog(lanes);
  const Lanes bells = bell(lanes - 25.0F);
  float all[kLanes];
  for (unsigned i = 0; i < kLanes; ++i) {
    EXPECT_EQ(valuesOf(logs)[i], naturalLog(values[i]));
    EXPECT_EQ(valuesOf(bells)[i], bell(values[i] - 25.0F));
    all[i] = values[i];
  }
  EXPECT_EQ(sum(lanes),
            ((all[0] + all[4]) + (all[2] + all[6])) + ((all[1] + all[5]) + (all[3] + all[7])));
  EXPECT_EQ(least(lanes), *std::min_element(all, all + kLanes));
  const std::uint32_t bits = maskBits(lanes > 20.0F);
  for (unsigned i = 0; i < kLanes; ++i) EXPECT_EQ((bits >> i & 1) != 0, values[i] > 20.0F);
}

TEST(Lanes, ThatAreKeptStandSideBySideWhicheverTheyAre) {
  const std::array<float, kLanes> numbers{3, 1, 4, 1.5F, 9, 2, 6, 5};
  for (std::uint32_t bits = 0; bits < 256; ++bits) {
    std::vector<float> expected;
    for (unsigned i = 0; i < kLanes; ++i) {
      if ((bits >> i & 1) != 0) expected.push_back(numbers[i]);
    }
    const Packing packing(bits);
    std::array<float, kLanes> stored{};
    packing.store(stored.data(), load(numbers.data()));
    ASSERT_EQ(packing.count(), expected.size()) << bits;
    const std::vector<float> kept(stored.begin(), stored.begin() + packing.count());
    EXPECT_EQ(kept, expected) << bits;
  }
}

TEST(Lanes, SumsOfEightAreTheSumsOfEach) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-1000, 1000);
  std::array<Lanes, kLanes> vectors{};
  for (Lanes& vector : vectors) {
    std::array<float, kLanes> numbers{};
    for (float& x : numbers) x = any(random);
    vector = load(numbers.data());
  }
  const std::array<float, kLanes> all = valuesOf(sums(vectors));
  for (unsigned i = 0; i < kLanes; ++i) EXPECT_EQ(all[i], sum(vectors[i])) << i;
}

TEST(Counter, LearnsAFrequency) {
  Counter counter;
  EXPECT_EQ(counter.evidence(), 0);
  std::mt19937 random(1);
  for (int i = 0; i < 4000; ++i) counter.update(random() % 10 == 0);
  EXPECT_NEAR(counter.evidence(), std::log(0.1 / 0.9), 0.4);
  for (int i = 0; i < 4000; ++i) counter.update(true);
  EXPECT_GT(counter.probabilityOfOne(), 65000U);
  EXPECT_LT(counter.probabilityOfOne(), 65536U);
}

/// Decisions that the third of four sources foretells, if the selector says so.
class Decisions {
 public:
  template <class Coder>
  void code(Coder& coder, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      const auto mode = static_cast<unsigned>(random_() % 2);
      const auto hint = static_cast<float>(random_() % 2) * 2 - 1;
      const bool noise = random_() % 16 == 0;
      const bool bit = noise ? random_() % 2 == 0 : (hint > 0) == (mode == 0);
      evidence_.clear();
      evidence_.add(1);
      evidence_.add(static_cast<float>(random_() % 9) - 4);
      evidence_.add(2 * hint);
      evidence_.add(counters_[mode]);
      ASSERT_EQ(mixer_.code(coder, bit, evidence_, {mode, 0}), bit) << i;
    }
  }

 private:
  Evidence evidence_;
  LogisticMixer<2> mixer_{{2, 1}, 4, 0.1F, {}, 60};
  std::mt19937 random_{3};
  std::array<Counter, 2> counters_{};
};

TEST(LogisticMixer, FindsOutWhichSourceToBelieveAndDecodesAlike) {
  constexpr unsigned kCount = 20000;
  SymbolWriter writer;
  Decisions written;
  written.code(writer, kCount);
  const Bytes bytes = writer.finish();
  // One in 32 decisions is a surprise: 0.2 bits each.
  EXPECT_LT(bytes.size() * 8, kCount * 0.23);
  SymbolReader reader(bytes);
  Decisions read;
  read.code(reader, kCount);
  EXPECT_NO_THROW(reader.finish());
}

}  // namespace
}  // namespace bspc::entropy
