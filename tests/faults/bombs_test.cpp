// Small files that claim a great deal, with checksums that are right: refused before anything is
// allocated for what they claim.

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "attributes/array_coder.h"
#include "attributes/order_coder.h"
#include "bspc/error.h"
#include "codec/codec_support.h"
#include "connectivity/connectivity_coder.h"
#include "connectivity/numbers.h"
#include "container/array_table.h"
#include "container/block.h"
#include "container/container_writer.h"
#include "entropy/symbol_coder.h"
#include "faults/counted_memory.h"
#include "geometry/geometry_method.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

using container::ByteWriter;
using container::FileHead;

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

/// What an action is refused with; nothing if it is not. It may not allocate `most` bytes.
std::optional<ErrorCode> refusal(std::uint64_t most, const std::function<void()>& action) {
  std::optional<ErrorCode> code;
  const test::PeakOfMemory peak;
  try {
    action();
  } catch (const Error& error) {
    code = error.code();
  }
  EXPECT_LT(peak.bytes(), most);
  return code;
}

std::optional<ErrorCode> refusalOf(const Bytes& file, std::uint64_t most,
                                   const OpenOptions& options = {}) {
  return refusal(most, [&] { test::open(file, options).decode(); });
}

/// A head block with records, which are given as they stand there.
Bytes fileWithRecord(unsigned tag, const Bytes& record) {
  FileHead head;
  head.keepsOrder = true;
  Bytes content = container::writeHead(head);
  // Behind the flags and the grid: one record, that of the order, of no bytes; then no tiles.
  content.resize(content.size() - 4);
  ByteWriter rest;
  rest.varint(1);
  rest.u8(tag);
  rest.varint(record.size());
  rest.bytes(record);
  rest.varint(0);
  content.insert(content.end(), rest.data().begin(), rest.data().end());
  Bytes file(container::kSignature.begin(), container::kSignature.end());
  file.push_back(container::kVersionMajor);
  file.push_back(container::kVersionMinor);
  const Bytes block = container::makeBlock(container::BlockType::Head, content, file);
  file.insert(file.end(), block.begin(), block.end());
  return file;
}

class PointBomb : public testing::TestWithParam<Method> {
 protected:
  /// One tile whose points lie at one place, as many as are claimed; its payload is that of two.
  static Bytes file(std::uint64_t points) {
    const std::vector<GridPoint> two(2, GridPoint{5, 5, 5});
    geometry::TileInput tile;
    tile.points = two;
    tile.lower = two[0];
    const geometry::GeometryMethod& method = *geometry::findGeometryMethod(GetParam());
    geometry::EncodedTile coded = method.encode(tile, {});
    FileHead head;
    head.grid.scalarType = ScalarType::UInt32;
    MemorySink sink;
    container::ContainerWriter writer(sink, Layout::Progressive, head);
    container::TileRecord record;
    record.method = static_cast<unsigned>(GetParam());
    record.version = coded.version;
    record.points = points;
    record.lower = two[0];
    writer.addTile(std::move(record), std::move(coded.layers));
    writer.finish();
    return sink.take();
  }
};

TEST_P(PointBomb, IsRefusedBeforeTheFirstPoint) {
  const auto visitTiles = [](const Bytes& bomb) {
    test::open(bomb).decodeTiles({}, [](DecodedPoints&&) {});
  };
  for (const std::uint64_t points : {std::uint64_t{1} << 40, std::uint64_t{1} << 32,
                                     std::uint64_t{0xFFFFFF00}, ~std::uint64_t{0}}) {
    const Bytes bomb = file(points);
    EXPECT_LT(bomb.size(), 100U);
    const ErrorCode expected = points < 0xFFFFFFFF ? ErrorCode::LimitExceeded : ErrorCode::Corrupt;
    EXPECT_EQ(refusalOf(bomb, kMegabyte), expected) << points;
    EXPECT_EQ(refusal(kMegabyte, [&] { visitTiles(bomb); }), expected) << points;
  }
}

TEST_P(PointBomb, OfPointsThatTheLimitOfMemoryIsTooLowForIsRefusedBeforeTheFirst) {
  OpenOptions options;
  options.limits.memoryBytes = 64 * kMegabyte;
  EXPECT_EQ(refusalOf(file(std::uint64_t{1} << 24), kMegabyte, options), ErrorCode::LimitExceeded);
}

INSTANTIATE_TEST_SUITE_P(Methods, PointBomb, testing::ValuesIn(availableMethods()),
                         [](const auto& test) { return std::string(methodName(test.param)); });

/// A tile whose payload holds more points than its record says.
TEST(Bomb, APlaceWithMorePointsThanItsTileIsRefusedBeforeTheFirst) {
  std::vector<GridPoint> points(300000, GridPoint{});
  points[0] = {1, 1, 1};
  geometry::TileInput tile;
  tile.extent = {1, 1, 1};
  tile.points = points;
  for (const Method id : {Method::Fast, Method::Octree, Method::GenCode, Method::Surface}) {
    const geometry::GeometryMethod& method = *geometry::findGeometryMethod(id);
    const geometry::EncodedTile coded = method.encode(tile, {});
    geometry::TileToDecode decode;
    decode.points = 10;
    decode.extent = tile.extent;
    decode.payloads.emplace_back(coded.layers[0]);
    decode.maxPoints = decode.maxBytes = std::uint64_t{1} << 33;
    decode.maxDepth = 512;
    EXPECT_EQ(refusal(2 * kMegabyte, [&] { method.decode(decode, {}); }), ErrorCode::Corrupt)
        << methodName(id);
  }
}

TEST(Bomb, ATableOfMoreTilesThanThereAreBytesIsRefused) {
  FileHead head;
  Bytes content = container::writeHead(head);
  content.pop_back();
  ByteWriter count;
  count.varint(std::uint64_t{1} << 24);
  content.insert(content.end(), count.data().begin(), count.data().end());
  Bytes file(container::kSignature.begin(), container::kSignature.end());
  file.push_back(container::kVersionMajor);
  file.push_back(container::kVersionMinor);
  const Bytes block = container::makeBlock(container::BlockType::Head, content, file);
  file.insert(file.end(), block.begin(), block.end());
  EXPECT_EQ(refusalOf(file, kMegabyte), ErrorCode::Corrupt);
}

/// Tiles that lack all layers but one take a few bytes each, and their places a great many.
FileHead headOfThinTiles(std::size_t tiles) {
  FileHead head;
  head.layers = 32;
  head.keepsOrder = true;
  container::TileRecord record;
  record.method = static_cast<unsigned>(Method::Kd);
  record.points = 1;
  record.order = container::TileOrder::Decoded;
  record.addLacking(31);
  record.chunkSizes.assign(head.layout().columns(), 0);
  head.tiles.assign(tiles, record);
  return head;
}

TEST(Bomb, ATableOfTilesStaysWithinTheLimit) {
  const Bytes file = container::fileStart(headOfThinTiles(20000));
  OpenOptions options;
  std::optional<ErrorCode> code;
  for (std::uint64_t limit = kMegabyte; code != ErrorCode::Truncated; limit *= 2) {
    ASSERT_LT(limit, 200 * kMegabyte);
    EXPECT_TRUE(!code || code == ErrorCode::LimitExceeded);
    options.limits.memoryBytes = limit;
    code = refusalOf(file, limit + 4 * file.size() + kMegabyte, options);
  }
}

TEST(Bomb, ATableOfMoreArraysThanTheLimitIsRefused) {
  ByteWriter table;
  table.varint(std::uint64_t{1} << 50);
  EXPECT_EQ(refusalOf(fileWithRecord(1, table.take()), kMegabyte), ErrorCode::LimitExceeded);
  table = ByteWriter();
  table.varint(4096);
  EXPECT_EQ(refusalOf(fileWithRecord(1, table.take()), kMegabyte), ErrorCode::Corrupt);
}

TEST(Bomb, AnArrayOfMoreComponentsThanThereAreNamesIsRefused) {
  ByteWriter table;
  table.varint(1);
  container::writeText(table, "name");
  table.u8(1U << 4);  // float32, with names of components
  table.varint(65536);
  EXPECT_EQ(refusalOf(fileWithRecord(1, table.take()), 4 * kMegabyte), ErrorCode::Corrupt);
}

TEST(Bomb, CellsThatTakeNoBytesAreRefusedBeforeTheFirst) {
  const std::vector<GridPoint> points(4);
  for (const unsigned sort : {0U, 1U, 2U}) {
    entropy::SymbolWriter coder;
    const std::uint64_t many = std::uint64_t{1} << 40;
    coder.raw(0, 4);  // the version
    connectivity::codeNumber(coder, sort == 0 ? many : 0);
    connectivity::codeNumber(coder, sort == 1 ? many : 0);
    coder.raw(sort == 2 ? 1 : 0, 1);
    coder.raw(0, 1);
    if (sort == 2) {
      connectivity::codeNumber(coder, many);  // regular faces
      connectivity::codeNumber(coder, 0);
      coder.raw(0, 4);
      coder.raw(1, 5);
    }
    const Bytes payload = coder.finish();
    EXPECT_EQ(
        refusal(
            kMegabyte,
            [&] {
              connectivity::decodeMesh({points, {1, 1, 1}}, payload, std::uint64_t{16} << 30, {});
            }),
        ErrorCode::LimitExceeded)
        << sort;
  }
}

/// A record of metadata that is this frame of zstd.
Bytes fileWithFrame(const Bytes& frame) {
  Bytes record{1};
  record.insert(record.end(), frame.begin(), frame.end());
  return fileWithRecord(128, record);
}

TEST(Bomb, AFrameThatClaimsAHugeContentOrWindowIsRefused) {
  // Magic number; one segment and a content size of eight bytes; that size; a last block of none.
  const Bytes content{0x28, 0xB5, 0x2F, 0xFD, 0xE0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0};
  EXPECT_EQ(refusalOf(fileWithFrame(content), kMegabyte), ErrorCode::Corrupt);
  // No segment but a window of 128 MiB.
  const Bytes window{0x28, 0xB5, 0x2F, 0xFD, 0x00, 0x88, 1, 0, 0};
  EXPECT_EQ(refusalOf(fileWithFrame(window), kMegabyte), ErrorCode::Corrupt);
}

TEST(Bomb, AFrameOfAGreatManyZerosIsRefused) {
  const Bytes zeros(64 * kMegabyte);
  Bytes frame(ZSTD_compressBound(zeros.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), zeros.data(), zeros.size(), 1));
  OpenOptions options;
  options.limits.memoryBytes = 64 * kMegabyte;
  EXPECT_EQ(refusalOf(fileWithFrame(frame), 16 * kMegabyte, options), ErrorCode::LimitExceeded);
}

TEST(Bomb, AGreatManyShortTextsStayWithinTheLimit) {
  Metadata metadata;
  ArrayValues texts;
  texts.name = "texts";
  texts.type = ScalarType::String;
  texts.strings.resize(300000);
  metadata.fieldData.push_back(texts);
  for (unsigned i = 0; i < 20000; ++i) metadata.entries.emplace_back(std::to_string(i), "");
  FileHead head;
  head.metadata = metadata;
  const Bytes file = container::fileStart(head);
  OpenOptions options;
  unsigned opened = 0;
  for (options.limits.memoryBytes = kMegabyte; opened == 0; options.limits.memoryBytes *= 2) {
    const test::PeakOfMemory peak;
    try {
      const Decoder decoder = test::open(file, options);
      ++opened;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::LimitExceeded);
    }
    EXPECT_LT(peak.bytes(), options.limits.memoryBytes + 4 * file.size() + kMegabyte);
  }
}

/// Every method of arrays, with settings that claim as much as they can.
TEST(Bomb, PayloadsOfArraysStayWithinTheLimit) {
  const std::vector<GridPoint> points = test::scannedSphere(4, 500, 1000);
  constexpr std::uint64_t kLimit = kMegabyte;
  constexpr std::uint64_t kModels = 4 * kMegabyte;
  for (unsigned type = 0; type <= static_cast<unsigned>(ScalarType::String); ++type) {
    for (unsigned method = 0; method < 9; ++method) {
      for (unsigned settings = 0; settings < 8; ++settings) {
        for (const unsigned fill : {0x00U, 0x7FU, 0xFFU}) {
          Bytes payload(40, static_cast<std::uint8_t>(fill));
          payload[0] = static_cast<std::uint8_t>(method);
          payload[1] = static_cast<std::uint8_t>(settings);
          attributes::TilePoints tile(points);
          attributes::ArrayValues values;
          const attributes::ArrayShape shape{static_cast<ScalarType>(type), 3, Semantic::None};
          refusal(kLimit + kModels,
                  [&] { attributes::decodeArray(shape, payload, tile, kLimit, values); });
        }
      }
    }
  }
}

/// Strings of one letter take as many bytes as they like in as few.
TEST(Bomb, AListOfStringsThatClaimsHugeOnesIsRefused) {
  const std::vector<GridPoint> points(10);
  for (const unsigned bits : {35U, 62U}) {
    ByteWriter lengths;
    for (std::size_t i = 0; i < points.size(); ++i) lengths.varint(std::uint64_t{1} << bits);
    ByteWriter payload;
    payload.u8(6);  // method Strings
    payload.u8(0);  // each by itself
    payload.varint(lengths.data().size());
    payload.varint(1);  // plain bytes
    payload.bytes(lengths.data());
    payload.varint(0);  // equal bytes
    payload.u8('a');
    attributes::TilePoints tile(points);
    attributes::ArrayValues values;
    const Bytes bytes = payload.take();
    EXPECT_EQ(refusal(kMegabyte,
                      [&] {
                        attributes::decodeArray({ScalarType::String, 1, Semantic::None}, bytes,
                                                tile, std::uint64_t{16} << 30, values);
                      }),
              ErrorCode::LimitExceeded);
  }
}

TEST(Bomb, TooFewBytesForTheOrderOfManyPointsAreRefused) {
  const std::vector<GridPoint> points(100000);
  for (const std::uint64_t limit : {kMegabyte, 64 * kMegabyte}) {
    for (unsigned kind = 0; kind < 4; ++kind) {
      const Bytes payload{static_cast<std::uint8_t>(kind), 0xFF, 0xFF, 0x7F};
      EXPECT_TRUE(
          refusal(limit + kMegabyte, [&] { attributes::decodeOrder(points, payload, limit); }));
    }
  }
}

}  // namespace
}  // namespace bspc
