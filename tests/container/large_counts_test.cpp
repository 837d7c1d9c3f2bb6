// Counts beyond 2^32 pass through everything that counts, without the points being there.

#include <gtest/gtest.h>

#include "bspc/decoder.h"
#include "bspc/join.h"
#include "codec/codec_support.h"
#include "container/container_writer.h"
#include "tiling/cell_groups.h"

namespace bspc::container {
namespace {

constexpr std::uint64_t kTilePoints = 0xFFFFFFFF;

/// A file whose tiles claim 2^32 − 1 points each; their payloads are not to be decoded.
Bytes hugeFile(Layout layout, std::size_t tiles) {
  FileHead head;
  head.grid.scalarType = ScalarType::UInt32;
  head.layers = 2;
  MemorySink sink;
  ContainerWriter writer(sink, layout, head);
  for (std::size_t t = 0; t < tiles; ++t) {
    TileRecord record;
    record.method = static_cast<unsigned>(Method::Kd);
    record.points = kTilePoints;
    record.lower = {static_cast<std::uint32_t>(1000 * t), 0, 0};
    record.extent = {999, 9, 9};
    record.coarse = {{kTilePoints / 2, 1}};
    writer.addTile(std::move(record), {Bytes(100, 1), Bytes(1000, 2)});
  }
  writer.finish();
  return sink.take();
}

TEST(LargeCounts, AreSummedUpInTheIndex) {
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    const Bytes file = hugeFile(layout, 5);
    const Decoder decoder = test::open(file);
    EXPECT_EQ(decoder.info().points, 5 * kTilePoints);
    EXPECT_EQ(decoder.info().layers[0].points, 5 * (kTilePoints / 2));
    EXPECT_EQ(decoder.info().layers[1].points, 5 * kTilePoints);
    DecodeOptions query;
    EXPECT_EQ(decoder.cost(query).points, 5 * kTilePoints);
    query.maxPoints = 5 * kTilePoints - 1;
    EXPECT_EQ(decoder.cost(query).level, 0U);
    query.maxPoints = 5 * kTilePoints;
    EXPECT_EQ(decoder.cost(query).level, 1U);
    query.box = Box{{1500, 0, 0}, {2500, 9, 9}};
    EXPECT_EQ(decoder.cost(query).points, 2 * kTilePoints);
  }
}

TEST(LargeCounts, AreSummedUpInJoinedFiles) {
  const Bytes file = hugeFile(Layout::Streaming, 3);
  MemorySink sink;
  const std::vector<std::shared_ptr<ByteSource>> files(2, std::make_shared<MemorySource>(file));
  const JoinReport report = join(files, sink);
  EXPECT_EQ(report.points, 6 * kTilePoints);
  EXPECT_EQ(test::open(sink.bytes()).info().points, 6 * kTilePoints);
}

TEST(LargeCounts, SumsThatAFileOnlyClaimsStopAtTheTop) {
  MemorySink sink;
  ContainerWriter writer(sink, Layout::Progressive, FileHead());
  for (int t = 0; t < 3; ++t) {
    TileRecord record;
    record.method = static_cast<unsigned>(Method::Kd);
    record.points = 0xFFFFFFFFFFFFFFF0;
    writer.addTile(std::move(record), {Bytes(10, 1)});
  }
  writer.finish();
  EXPECT_EQ(test::open(sink.bytes()).info().points, 0xFFFFFFFFFFFFFFFF);
}

TEST(LargeCounts, CellsAreGroupedByThem) {
  constexpr std::uint64_t kMany = std::uint64_t{1} << 33;
  const tiling::CellGroups groups = tiling::groupCells({kMany, 1, kMany / 2, kMany / 2}, kMany);
  EXPECT_EQ(groups.sizes, (std::vector<std::uint64_t>{kMany, 1, kMany}));
  EXPECT_EQ(groups.groupOf[0], 0U);
  EXPECT_EQ(groups.groupOf[1], 1U);
  EXPECT_EQ(groups.groupOf[2], 2U);
  EXPECT_EQ(groups.groupOf[3], 2U);
}

}  // namespace
}  // namespace bspc::container
