// Files with arrays that are damaged, cut short, or forged with right checksums.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "container/container_reader.h"
#include "container/container_writer.h"
#include "support/array_sets.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

Bytes sampleFile(Layout layout, Method method, bool keepOrder = false) {
  constexpr std::size_t kPoints = 400;
  const std::vector<std::int32_t> xyz = test::asIntegers(test::scannedSphere(3, kPoints, 1023));
  const std::vector<ArrayValues> arrays = test::arraysOfAllTypes(kPoints);
  PointSetView view(xyz.data(), kPoints);
  for (const ArrayValues& array : arrays) view.addArray(array.view());
  EncodeOptions options;
  options.method = method;
  options.layers = 2;
  options.tilePoints = 250;
  options.layout = layout;
  options.keepOrder = keepOrder;
  options.metadata.crs = "EPSG:25832";
  options.metadata.fieldData = test::arraysOfAllTypes(3);
  return test::encoded(view, options);
}

bool decodes(const Bytes& file, const OpenOptions& options = {}) {
  try {
    test::open(file, options).decode();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()), "");
    return false;
  }
  return true;
}

TEST(DamagedArrays, EveryWrongBitIsNoticed) {
  const Bytes good = sampleFile(Layout::Progressive, Method::Fast);
  ASSERT_TRUE(decodes(good));
  for (std::size_t at = 0; at < good.size(); at += 5) {
    Bytes bad = good;
    bad[at] ^= static_cast<std::uint8_t>(1U << (at % 8));
    ASSERT_FALSE(decodes(bad)) << at;
  }
}

TEST(DamagedArrays, APrefixHasArraysOfItsWholeLayers) {
  const Bytes good = sampleFile(Layout::Progressive, Method::Fast);
  OpenOptions partial;
  partial.allowPartial = true;
  bool anyLayer = false;
  for (std::size_t size = 1; size < good.size(); size += 23) {
    const Bytes bad(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(decodes(bad)) << size;
    try {
      Decoder decoder = test::open(bad, partial);
      EXPECT_EQ(decoder.info().wholeLayers, 1U);
      const DecodedPoints decoded = decoder.decode();
      EXPECT_FALSE(decoded.complete);
      ASSERT_EQ(decoded.arrays.size(), 12U);
      EXPECT_EQ(decoded.arrays[3].tuples(), decoded.points.size());
      anyLayer = true;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Truncated);
    }
  }
  EXPECT_TRUE(anyLayer);
}

/// The file with changed records and payloads, and checksums that are right again.
Bytes forged(const Bytes& good, const std::function<void(container::FileHead&)>& changeHead,
             const std::function<void(std::size_t tile, std::size_t column, Bytes&)>& changeChunk) {
  const container::ContainerReader reader(std::make_shared<MemorySource>(good), {});
  container::FileHead head = reader.head();
  const container::TileLayout layout = head.layout();
  std::vector<std::vector<Bytes>> chunks(head.tiles.size());
  for (std::size_t t = 0; t < head.tiles.size(); ++t) {
    for (std::size_t c = 0; c < layout.columns(); ++c) {
      chunks[t].emplace_back();
      if (!head.tiles[t].hasChunk(layout, c)) continue;
      chunks[t][c] = reader.chunk(t, c);
      changeChunk(t, c, chunks[t][c]);
      head.tiles[t].chunkSizes[c] = chunks[t][c].size();
    }
  }
  changeHead(head);
  MemorySink sink;
  container::writeProgressive(sink, head,
                              [&](std::size_t t, std::size_t c) { return chunks[t][c]; }, {});
  return sink.take();
}

TEST(DamagedArrays, ForgedPayloadsAreErrors) {
  for (const Method method : {Method::Fast, Method::Kd}) {
    const Bytes good = sampleFile(Layout::Progressive, method, method == Method::Kd);
    std::mt19937_64 random(17);
    for (unsigned trial = 0; trial < 300; ++trial) {
      bool changed = false;
      const Bytes bad = forged(
          good, [](container::FileHead&) {},
          [&](std::size_t /*tile*/, std::size_t column, Bytes& payload) {
            if (column == 0 || random() % 20 != 0 || payload.empty()) return;
            changed = true;
            for (std::uint64_t i = 1 + random() % 3; i > 0; --i) {
              payload[random() % payload.size()] = static_cast<std::uint8_t>(random());
            }
            if (random() % 5 == 0) payload.resize(random() % payload.size() + 1);
          });
      if (!changed || bad == good) continue;
      ASSERT_FALSE(decodes(bad)) << "trial " << trial;
    }
  }
}

TEST(DamagedArrays, ForgedTablesAreErrors) {
  const Bytes good = sampleFile(Layout::Progressive, Method::Fast);
  const auto keep = [](std::size_t, std::size_t, Bytes&) {};
  const auto fails = [&](const std::function<void(container::FileHead&)>& change) {
    return !decodes(forged(good, change, keep));
  };
  EXPECT_FALSE(fails([](container::FileHead&) {}));
  EXPECT_TRUE(fails([](auto& head) { head.arrays[1].name = head.arrays[0].name; }));
  EXPECT_TRUE(fails([](auto& head) { head.arrays[1].name = ""; }));
  EXPECT_TRUE(fails([](auto& head) { head.arrays[4].components += 1; }));
  EXPECT_TRUE(fails([](auto& head) { head.arrays[4].components = 0; }));
  EXPECT_TRUE(fails([](auto& head) { head.arrays[4].components = 70000; }));
  EXPECT_TRUE(fails([](auto& head) { head.tiles[0].arrays[2].contentChecksum ^= 1; }));
  EXPECT_TRUE(fails([](auto& head) { head.keepsOrder = true; }));
  EXPECT_TRUE(fails([](auto& head) { std::swap(head.arrays[2], head.arrays[7]); }));
}

TEST(DamagedArrays, LimitsHold) {
  const Bytes good = sampleFile(Layout::Streaming, Method::Fast);
  OpenOptions few;
  few.limits.arrays = 11;
  EXPECT_FALSE(decodes(good, few));
  OpenOptions little;
  little.limits.memoryBytes = 20000;
  EXPECT_FALSE(decodes(good, little));
}

}  // namespace
}  // namespace bspc
