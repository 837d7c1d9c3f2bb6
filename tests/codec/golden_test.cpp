// Files of earlier builds decode to the same points, and today's encoder still writes the same
// bytes. tests/codec/write_golden.cpp makes the files anew when the encoder changes on purpose;
// those of Testing/Data/frozen_1.0 stay, and tests/conformance checks that they are still read.

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/codec_support.h"
#include "codec/golden_files.h"
#include "support/array_sets.h"

namespace bspc {
namespace {

class Golden : public testing::TestWithParam<test::GoldenFile> {};

TEST_P(Golden, DecodesToTheFixedPoints) {
  const test::GoldenFile& file = GetParam();
  const Bytes bytes = test::readGolden(test::goldenPath(file.name));
  test::DecodedOrder wanted;
  test::encodeGolden(file, &wanted);
  Decoder decoder = test::open(bytes);
  const DecodedPoints decoded = decoder.decode();
  std::vector<double> back(3 * decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  ASSERT_EQ(back.size(), wanted.xyz.size());
  // All of them lie on lattices but the quantised one, which has 9 bits over an extent of 124.
  const double allowed = file.options.grid.kind == GridRequest::Kind::Bits ? 0.13 : 0;
  for (std::size_t i = 0; i < back.size(); ++i) ASSERT_NEAR(back[i], wanted.xyz[i], allowed);
  ASSERT_EQ(decoded.arrays.size(), file.arrays.size());
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    ASSERT_EQ(test::tuplesOf(decoded.arrays, i), wanted.tuples[i]);
  }
}

TEST_P(Golden, DecodesToTheFixedFaces) {
  const test::GoldenFile& file = GetParam();
  test::DecodedOrder wanted;
  test::encodeGolden(file, &wanted);
  const Bytes bytes = test::readGolden(test::goldenPath(file.name));
  const DecodedPoints decoded = test::open(bytes).decode();
  ASSERT_EQ(decoded.mesh.faces.size(), file.cells.faces.size());
  for (std::size_t i = 0; i < decoded.mesh.faces.size(); ++i) {
    std::vector<std::uint64_t> face;
    for (const std::uint32_t v : decoded.mesh.faces[i]) face.push_back(wanted.points[v]);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    const auto given = file.cells.faces[static_cast<std::size_t>(wanted.cells[i])];
    std::vector<std::uint64_t> cycle(given.begin(), given.end());
    std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
    ASSERT_EQ(face, cycle);
    ASSERT_EQ(test::tuplesOf(decoded.cellArrays, i), wanted.cellTuples[i]);
  }
  ASSERT_EQ(decoded.cellArrays.size(), file.cellArrays.size());
}

TEST_P(Golden, IsWrittenByteForByte) {
  // Versions of zstd, which codes some values, need not write the same bytes.
  if (!GetParam().arrays.empty() || !GetParam().cellArrays.empty()) return;
  const Bytes bytes = test::readGolden(test::goldenPath(GetParam().name));
  EXPECT_EQ(test::encodeGolden(GetParam(), nullptr), bytes);
}

INSTANTIATE_TEST_SUITE_P(Files, Golden, testing::ValuesIn(test::goldenFiles()),
                         [](const auto& file) { return file.param.name; });

}  // namespace
}  // namespace bspc
