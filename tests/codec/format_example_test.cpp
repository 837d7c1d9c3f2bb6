// The worked example of docs/format.md is what the encoder writes, and decodes.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "codec/codec_support.h"

namespace bspc {
namespace {

/// The bytes of the example: lines of the form "offset  hex hex …  explanation" between the two
/// marks, hex pairs up to two blanks.
Bytes exampleBytes() {
  std::ifstream in(BSPC_SOURCE_DIR "/docs/format.md");
  EXPECT_TRUE(in);
  Bytes bytes;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("<!-- example:", 0) == 0) inside = line.find("begin") != std::string::npos;
    if (!inside || line.size() < 6 || line.compare(0, 2, "00") != 0) continue;
    EXPECT_EQ(std::stoul(line.substr(0, 4), nullptr, 16), bytes.size()) << line;
    const std::size_t first = 6;
    std::istringstream pairs(line.substr(first, line.find("  ", first) - first));
    for (std::string pair; pairs >> pair;) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(pair, nullptr, 16)));
    }
  }
  return bytes;
}

TEST(FormatSpecification, ItsExampleIsARealFile) {
  const std::vector<float> xyz{0.25F, 1.5F,  -2.0F,  1.0F,  1.5F, -2.0F,
                               0.25F, 2.25F, -1.75F, 0.75F, 2.0F, -1.25F};
  EncodeOptions options;
  options.method = Method::Kd;
  const Bytes example = exampleBytes();
  EXPECT_EQ(test::encoded(PointSetView(xyz.data(), 4), options), example);
  Decoder decoder = test::open(example);
  const DecodedPoints decoded = decoder.decode();
  const std::vector<GridPoint> wanted{{0, 0, 0}, {0, 3, 1}, {3, 0, 0}, {2, 2, 3}};
  EXPECT_EQ(decoded.points, wanted);
  std::vector<float> back(12);
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());
  const std::vector<float> inOrder{0.25F, 1.5F, -2.0F, 0.25F, 2.25F, -1.75F,
                                   1.0F,  1.5F, -2.0F, 0.75F, 2.0F,  -1.25F};
  EXPECT_EQ(back, inOrder);
}

}  // namespace
}  // namespace bspc
