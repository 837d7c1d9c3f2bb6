#include "geometry/fast/set_coder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "geometry/kd/kd_method.h"

namespace bspc::geometry::fast {

namespace {

/// How a set is coded: the low bits of its first byte. The high four are the UvTree's levels.
enum Kind : unsigned { kCurve = 0, kTree = 1, kCounts = 2, kKinds = 3 };
constexpr unsigned kKindBits = 4;
/// More would let a few bytes ask for much work: a tree's counts grow twofold with every level.
constexpr unsigned kMaxExtraLevels = 6;

/// Sets of so few points may be too small for the statistics of slabs.
constexpr std::size_t kFewPoints = 8192;

SlabOptions presetOf(unsigned effort) {
  SlabOptions options;
  switch (effort) {
    case 0:
    case 1:
      options.plan.merge = false;
      options.plan.largestSlab = options.plan.smallestSlab = 700;
      options.fit.quadrics = false;
      break;
    case 2:
      break;
    case 3:
      options.uvTree = true;
      options.extraLevels = 3;
      options.plan.compareCosts = true;
      break;
    default:
      options.uvTree = true;
      options.extraLevels = kMaxExtraLevels;
  }
  return options;
}

CodedSet slabs(const TileFrame& frame, const SetPoints& points, const SlabOptions& options) {
  const unsigned kind =
      options.uvTree ? kTree | (options.extraLevels << kKindBits) : static_cast<unsigned>(kCurve);
  container::ByteWriter out;
  out.u8(kind);
  std::vector<std::uint32_t> order = writeSlabs(frame, points, options, out);
  return {out.take(), std::move(order)};
}

/// As a tile of method kd.
CodedSet counts(const TileFrame& frame, const SetPoints& points) {
  std::vector<GridPoint> positions;
  positions.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) positions.push_back(points[i].at);
  TileInput tile;
  tile.points = positions;
  tile.extent = frame.extent;
  EncodedTile coded = KdMethod().encode(tile, {});
  CodedSet set{std::move(coded.layers[0]), std::move(coded.order)};
  set.bytes.insert(set.bytes.begin(), static_cast<std::uint8_t>(kCounts));
  for (std::uint32_t& i : set.order) i = points[i].index;
  return set;
}

}  // namespace

CodedSet encodeSet(const TileFrame& frame, const SetPoints& points, unsigned effort) {
  CodedSet best;
  const auto consider = [&best](CodedSet candidate) {
    if (best.bytes.empty() || candidate.bytes.size() < best.bytes.size()) {
      best = std::move(candidate);
    }
  };
  const SlabOptions usual = presetOf(effort);
  consider(slabs(frame, points, usual));
  if (effort >= 4) {
    SlabOptions other = usual;
    other.plan.merge = false;
    other.plan.smallestSlab = other.plan.largestSlab;
    consider(slabs(frame, points, other));
    other = usual;
    other.plan.compareCosts = true;
    consider(slabs(frame, points, other));
  }
  if (points.size() <= kFewPoints) {
    for (const unsigned other : {2U, 3U}) {
      if (effort != other) consider(slabs(frame, points, presetOf(other)));
    }
    consider(counts(frame, points));
  }
  return best;
}

void decodeSet(ByteView payload, std::uint64_t points, const TileToDecode& limits,
               PointCollector& out) {
  if (payload.empty()) throw Error(ErrorCode::Corrupt, "a layer with points has no bytes");
  const unsigned kind = payload[0] & ((1U << kKindBits) - 1);
  const unsigned extraLevels = payload[0] >> kKindBits;
  const ByteView body = payload.subspan(1, payload.size() - 1);
  if (kind >= kKinds || extraLevels > (kind == kTree ? kMaxExtraLevels : 0)) {
    throw Error(ErrorCode::Corrupt,
                "a set of points is coded in an unknown way (" + std::to_string(payload[0]) + ")");
  }
  if (kind != kCounts) {
    readSlabs(body, points, kind == kTree, extraLevels, limits.maxDepth, out);
    return;
  }
  TileToDecode tile;
  tile.points = points;
  tile.extent = out.frame().extent;
  tile.payloads.push_back(body);
  tile.maxPoints = limits.maxPoints;
  tile.maxBytes = limits.maxBytes / 2;  // the result is copied
  tile.maxDepth = limits.maxDepth;
  const DecodedTile decoded = KdMethod().decode(tile, out.progress());
  out.append(decoded.points.data(), decoded.points.size());
}

}  // namespace bspc::geometry::fast
