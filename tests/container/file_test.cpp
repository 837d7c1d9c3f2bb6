// The container against damage, truncation, other versions and unknown parts.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <random>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "container/block.h"
#include "container/byte_writer.h"
#include "container/checksum.h"
#include "container/file_head.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

ErrorCode decodingError(const Bytes& file, bool allowPartial = false) {
  OpenOptions options;
  options.allowPartial = allowPartial;
  try {
    test::open(file, options).decode();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()), "");
    return error.code();
  }
  ADD_FAILURE() << "the file was accepted";
  return ErrorCode::Io;
}

Bytes sampleFile(Layout layout, unsigned layers = 3, std::optional<Method> method = std::nullopt) {
  EncodeOptions options;
  options.method = method;
  options.layout = layout;
  options.layers = layers;
  return test::encoded(test::scannedSphere(21, 900, 2047), options);
}

class EveryLayout : public testing::TestWithParam<Layout> {};

TEST_P(EveryLayout, NoticesEverySingleBitThatIsWrong) {
  const Bytes good = sampleFile(GetParam());
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= static_cast<std::uint8_t>(1U << (at % 8));
    SCOPED_TRACE("byte " + std::to_string(at) + " of " + std::to_string(good.size()));
    decodingError(bad);
  }
}

TEST_P(EveryLayout, NoticesEveryTruncation) {
  const Bytes good = sampleFile(GetParam());
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Bytes bad(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    SCOPED_TRACE(std::to_string(size) + " of " + std::to_string(good.size()) + " bytes");
    const ErrorCode code = decodingError(bad);
    EXPECT_TRUE(code == ErrorCode::Truncated || (size == 0 && code == ErrorCode::NotBspc))
        << errorCodeName(code);
  }
}

TEST_P(EveryLayout, NoticesBytesBehindTheEnd) {
  Bytes bad = sampleFile(GetParam());
  bad.push_back(0);
  decodingError(bad);
}

TEST_P(EveryLayout, SurvivesThousandsOfMutations) {
  const Bytes good = sampleFile(GetParam());
  std::mt19937_64 random(31);
  for (unsigned trial = 0; trial < 4000; ++trial) {
    Bytes bad = good;
    for (std::uint64_t i = 1 + random() % 6; i > 0 && !bad.empty(); --i) {
      const std::size_t at = random() % bad.size();
      switch (random() % 4) {
        case 0:
          bad[at] = static_cast<std::uint8_t>(random());
          break;
        case 1:
          bad.erase(bad.begin() + static_cast<std::ptrdiff_t>(at));
          break;
        case 2:
          bad.insert(bad.begin() + static_cast<std::ptrdiff_t>(at),
                     static_cast<std::uint8_t>(random()));
          break;
        default:
          bad.resize(std::max<std::size_t>(at, 1));
      }
    }
    if (bad == good) continue;
    if (trial % 2 == 0) {
      decodingError(bad);
      ASSERT_FALSE(HasFailure()) << "trial " << trial;
      continue;
    }
    // What ends early may be decoded as far as it is whole, and must be called incomplete.
    OpenOptions options;
    options.allowPartial = true;
    try {
      ASSERT_FALSE(test::open(bad, options).decode().complete) << "trial " << trial;
    } catch (const Error&) {
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Container, EveryLayout,
                         testing::Values(Layout::Progressive, Layout::Streaming),
                         [](const auto& layout) {
                           return layout.param == Layout::Streaming ? "streaming" : "progressive";
                         });

/// A file with another head content; the checksum is made right again.
Bytes withHead(const Bytes& good, const std::function<void(Bytes&)>& change,
               std::uint8_t versionMinor = container::kVersionMinor) {
  MemorySource source(good);
  container::Block head =
      container::readBlock(source, container::kPreambleSize, container::kPreambleSize, "the head");
  change(head.content);
  Bytes file(good.begin(), good.begin() + container::kPreambleSize);
  file.back() = versionMinor;
  const Bytes block = container::makeBlock(container::BlockType::Head, head.content, file);
  file.insert(file.end(), block.begin(), block.end());
  file.insert(file.end(), good.begin() + static_cast<std::ptrdiff_t>(head.end), good.end());
  return file;
}

TEST(Container, SurvivesMutatedHeadsWithRightChecksums) {
  // Checksums shield the parser from chance, not from malice.
  std::mt19937_64 random(33);
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    // The head is the same for every method, and this one decodes what heads claim most quickly.
    const Bytes good = sampleFile(layout, 3, Method::Fast);
    unsigned refused = 0;
    for (unsigned trial = 0; trial < 6000; ++trial) {
      const Bytes bad = withHead(good, [&random](Bytes& head) {
        for (std::uint64_t i = 1 + random() % 3; i > 0; --i) {
          const std::size_t at = random() % head.size();
          head[at] = static_cast<std::uint8_t>(random());
          if (random() % 4 == 0) head.insert(head.begin() + static_cast<std::ptrdiff_t>(at), 255);
          if (random() % 8 == 0) head.resize(std::max<std::size_t>(at, 1));
        }
      });
      OpenOptions options;
      options.limits.memoryBytes = 1 << 24;
      options.limits.points = 2000;  // so that a claim of many costs little
      options.allowPartial = trial % 2 == 0;
      try {
        test::open(bad, options).decode();
      } catch (const Error&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 1000U);
  }
}

TEST(Container, AFileThatIsSomethingElseIsNamedSo) {
  EXPECT_EQ(decodingError({'p', 'l', 'y', '\n', 'f', 'o', 'r', 'm', 'a', 't', ' '}),
            ErrorCode::NotBspc);
  EXPECT_FALSE(isBspc(Bytes{'p', 'l', 'y'}));
  EXPECT_TRUE(isBspc(sampleFile(Layout::Progressive)));
}

TEST(Container, ATransferInTextModeIsNoticed) {
  const Bytes good = sampleFile(Layout::Progressive);
  Bytes unixEnds;
  Bytes sevenBits;
  for (const std::uint8_t b : good) {
    if (b != '\r') unixEnds.push_back(b);
    sevenBits.push_back(b & 127);
  }
  EXPECT_EQ(decodingError(unixEnds), ErrorCode::NotBspc);
  EXPECT_EQ(decodingError(sevenBits), ErrorCode::NotBspc);
}

TEST(Container, OtherMajorVersionsAreRefusedAndANewerMinorIsRead) {
  Bytes major = sampleFile(Layout::Progressive);
  for (const unsigned other : {container::kVersionMajor + 1, container::kVersionMajor - 1}) {
    major[8] = static_cast<std::uint8_t>(other);
    EXPECT_EQ(decodingError(major), ErrorCode::Unsupported);
  }
  const Bytes minor = withHead(
      sampleFile(Layout::Progressive), [](Bytes&) {}, 200);
  EXPECT_EQ(test::open(minor).decode().points.size(), 900U);
}

TEST(Container, APrefixThatEndsOnALayerDecodes) {
  const Bytes good = sampleFile(Layout::Progressive, 3);
  Decoder whole = test::open(good);
  const std::vector<LayerInfo> layers = whole.info().layers;
  std::uint64_t end = good.size();
  for (unsigned missing = 1; missing < 3; ++missing) {
    end -= container::chunkSize(layers[3 - missing].bytes);
    const Bytes prefix(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(end));
    try {
      test::open(prefix);
      FAIL() << "a truncated file was opened without allowPartial";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Truncated);
      EXPECT_NE(std::string(error.what()).find(missing == 1 ? "layers 0 to 1" : "layer 0"),
                std::string::npos)
          << error.what();
    }
    OpenOptions options;
    options.allowPartial = true;
    Decoder partial = test::open(prefix, options);
    EXPECT_EQ(partial.info().wholeLayers, 3 - missing);
    const DecodedPoints decoded = partial.decode();
    EXPECT_FALSE(decoded.complete);
    EXPECT_EQ(decoded.points.size(), layers[2 - missing].points);
    DecodeOptions finer;
    finer.level = 2;
    EXPECT_THROW(partial.decode(finer), Error);
  }
}

TEST(Container, AStreamingFileWithoutItsEndGivesItsWholeTiles) {
  const Bytes good = sampleFile(Layout::Streaming);
  const Bytes cut(good.begin(), good.end() - 5);
  EXPECT_EQ(decodingError(cut), ErrorCode::Truncated);
  OpenOptions options;
  options.allowPartial = true;
  Decoder partial = test::open(cut, options);
  const DecodedPoints decoded = partial.decode();
  EXPECT_EQ(decoded.points.size(), 900U);
  EXPECT_FALSE(decoded.complete) << "nobody knows whether more tiles were to come";
}

/// Sets the flag that says that blocks follow the chunks, and appends them.
Bytes withTrailingBlocks(const std::vector<unsigned>& types, bool end) {
  Bytes file = withHead(sampleFile(Layout::Progressive), [](Bytes& head) { head[0] |= 0x80; });
  const auto append = [&file](const Bytes& block) {
    file.insert(file.end(), block.begin(), block.end());
  };
  for (const unsigned type : types) {
    append(container::makeBlock(static_cast<container::BlockType>(type), Bytes{1, 2, 3}));
  }
  if (end) append(container::makeBlock(container::BlockType::End, Bytes(8, 0)));
  return file;
}

TEST(Container, UnknownOptionalBlocksArePassedOver) {
  EXPECT_EQ(test::open(withTrailingBlocks({200, 128}, true)).decode().points.size(), 900U);
}

TEST(Container, UnknownRequiredBlocksAreRefused) {
  EXPECT_EQ(decodingError(withTrailingBlocks({100}, true)), ErrorCode::Unsupported);
}

TEST(Container, TrailingBlocksMustEnd) {
  EXPECT_EQ(decodingError(withTrailingBlocks({200}, false)), ErrorCode::Truncated);
  Bytes more = withTrailingBlocks({200}, true);
  const Bytes extra = container::makeBlock(static_cast<container::BlockType>(200), Bytes{1});
  more.insert(more.end(), extra.begin(), extra.end());
  EXPECT_EQ(decodingError(more), ErrorCode::Corrupt);
}

/// Inserts a list of records behind the grid (4 bytes: integers from 0 on, one tile).
Bytes withRecord(unsigned tag) {
  const std::vector<std::int32_t> xyz{0, 0, 0, 5, 5, 5};
  return withHead(test::encoded(PointSetView(xyz.data(), 2)), [tag](Bytes& head) {
    head[0] |= 0x40;
    const Bytes records{1, static_cast<std::uint8_t>(tag), 2, 7, 7};
    container::ByteWriter grid;
    head.insert(head.begin() + 5, records.begin(), records.end());
  });
}

TEST(Container, UnknownOptionalRecordsArePassedOverAndRequiredOnesRefused) {
  EXPECT_EQ(test::open(withRecord(200)).decode().points.size(), 2U);
  EXPECT_EQ(decodingError(withRecord(99)), ErrorCode::Unsupported);
}

TEST(Container, UnknownMethodsAndVersionsAreRefused) {
  const std::vector<std::int32_t> xyz{0, 0, 0, 5, 5, 5};
  const Bytes good = test::encoded(PointSetView(xyz.data(), 2));
  // Flags, grid (4), number of tiles, flags of the tile: then method and version.
  constexpr std::size_t kCoder = 7;
  for (const std::uint8_t coder : {std::uint8_t{0x7F}, std::uint8_t{0x1F}}) {
    const Bytes bad = withHead(good, [coder](Bytes& head) { head[kCoder] = coder; });
    EXPECT_EQ(test::open(bad).info().points, 2U) << "info needs no method";
    EXPECT_EQ(decodingError(bad), ErrorCode::Unsupported);
  }
}

TEST(Container, LimitsHold) {
  const Bytes good = sampleFile(Layout::Progressive);
  const auto fails = [&good](auto set) {
    OpenOptions options;
    set(options.limits);
    try {
      test::open(good, options).decode();
    } catch (const Error& error) {
      return error.code() == ErrorCode::LimitExceeded;
    }
    return false;
  };
  EXPECT_TRUE(fails([](DecodeLimits& l) { l.points = 899; }));
  EXPECT_FALSE(fails([](DecodeLimits& l) { l.points = 900; }));
  EXPECT_TRUE(fails([](DecodeLimits& l) { l.memoryBytes = 5000; }));
  EXPECT_TRUE(fails([](DecodeLimits& l) { l.tiles = 0; }));
  EXPECT_TRUE(fails([](DecodeLimits& l) { l.depth = 30; }));
}

}  // namespace
}  // namespace bspc
