#include "geometry/fast/tile_header.h"

#include <algorithm>
#include <cmath>

#include "geometry/fast/axis_remap.h"
#include "geometry/fast/tile_sequence.h"

namespace bspc::geometry::fast {

namespace {

constexpr unsigned kScaleFlag = 1U << 3;
constexpr unsigned kInputOrderFlag = 1U << 4;
constexpr unsigned kKnownFlags = (1U << 5) - 1;
constexpr unsigned kMaxScale = 31;
/// One point in 128 goes to the next coarser layer: points that lie so far apart cost about fifteen
/// bits more than they would among all, which comes to about 1 % of a tile; with one in 64 to 2 %.
constexpr unsigned kUsualRatioBits = 7;

StepScale scaleOf(const double (&step)[3]) {
  const double finest = std::min({step[0], step[1], step[2]});
  StepScale scale{};
  for (unsigned k = 0; k < 3; ++k) {
    scale[k] = static_cast<std::uint8_t>(std::floor(std::log2(step[k] / finest) + 0.5));
  }
  return scale;
}

}  // namespace

RankedPoints::RankedPoints(const TileInput& tile) : points_(tile.points), lower_(tile.lower) {
  TileFrame& frame = header_.frame;
  if (tile.layers > 1) header_.ratioBits = kUsualRatioBits;
  double regularStep[3] = {1, 1, 1};
  double meanStep[3] = {1, 1, 1};
  for (unsigned k = 0; k < 3; ++k) {
    const AxisColumn column(points_, k, lower_[k]);
    frame.extent[k] = tile.extent[k];
    frame.values[k] = valuesWorthRanking(column, tile.extent[k]);
    if (frame.values[k].empty()) continue;
    ranks_[k] = AxisRanks(column, frame.values[k]);
    frame.extent[k] = static_cast<std::uint32_t>(frame.values[k].size() - 1);
    meanStep[k] =
        (static_cast<double>(tile.extent[k]) + 1) / static_cast<double>(frame.values[k].size());
    if (isRegular(frame.values[k])) regularStep[k] = meanStep[k];
  }
  frame.scale = scaleOf(regularStep);
  otherScale_ = scaleOf(meanStep);
}

void writeHeader(container::ByteWriter& out, const TileHeader& header, unsigned layers) {
  const TileFrame& frame = header.frame;
  const bool scaled = (frame.scale[0] | frame.scale[1] | frame.scale[2]) != 0;
  unsigned flags = scaled ? kScaleFlag : 0;
  if (header.sequence == Sequence::Input) flags |= kInputOrderFlag;
  for (unsigned k = 0; k < 3; ++k) flags |= frame.values[k].empty() ? 0 : 1U << k;
  out.u8(flags);
  if (layers > 1) out.u8(header.ratioBits);
  if (scaled) {
    for (const std::uint8_t s : frame.scale) out.u8(s);
  }
  if (frame.hasRanks()) {
    const Bytes section = writeValues(frame.values);
    out.varint(section.size());
    out.bytes(section);
  }
}

TileHeader readHeader(container::ByteReader& in, const TileToDecode& tile,
                      const OutputBudget& budget) {
  TileHeader header;
  const unsigned flags = in.u8();
  if ((flags & ~kKnownFlags) != 0) in.fail("reserved flags that are set");
  if ((flags & kInputOrderFlag) != 0) header.sequence = Sequence::Input;
  if (tile.layers > 1) {
    header.ratioBits = in.u8();
    if (header.ratioBits == 0 || header.ratioBits > LayerStrides::kMaxRatioBits) {
      in.fail("an impossible ratio of layers");
    }
  }
  if ((flags & kScaleFlag) != 0) {
    for (std::uint8_t& s : header.frame.scale) {
      s = static_cast<std::uint8_t>(in.u8());
      if (s > kMaxScale) in.fail("an impossible scale of an axis");
    }
  }
  header.frame.extent = tile.extent;
  std::array<bool, 3> ranked{};
  for (unsigned k = 0; k < 3; ++k) ranked[k] = (flags & (1U << k)) != 0;
  if (ranked == std::array<bool, 3>{}) return header;
  const ByteView section = in.bytes(in.varint());
  header.frame.values = readValues(section, ranked, tile.points, tile.extent, budget);
  for (unsigned k = 0; k < 3; ++k) {
    if (!ranked[k]) continue;
    header.frame.extent[k] = static_cast<std::uint32_t>(header.frame.values[k].size() - 1);
  }
  return header;
}

}  // namespace bspc::geometry::fast
