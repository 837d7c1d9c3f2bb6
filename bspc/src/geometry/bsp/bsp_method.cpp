#include "geometry/bsp/bsp_method.h"

#include <memory>
#include <optional>

#include "bspc/error.h"
#include "geometry/bsp/bsp_points.h"
#include "geometry/bsp/bsp_tree_coder.h"
#include "geometry/tile_bounds.h"

namespace bspc::geometry {

namespace {

using Encoding = BspTreeCoder<entropy::SymbolWriter, BspSortedPoints>;
using Decoding = BspTreeCoder<entropy::SymbolReader, BspCollectedPoints>;

/// Throws BspSortedPoints::Lost if the parameters' slack is too small for this tile.
EncodedTile encodeWith(const BspParameters& parameters, const TileInput& tile,
                       const PointProgress& progress) {
  BspSortedPoints points(tile, progress);
  constexpr std::uint32_t kAnyDepth = std::numeric_limits<std::uint32_t>::max();
  const auto tree =
      std::make_unique<Encoding>(tile.extent, points, tile.points.size(), kAnyDepth, parameters);
  EncodedTile result;
  for (unsigned layer = 0; layer < tile.layers; ++layer) {
    entropy::SymbolWriter coder;
    if (layer == 0) tree->head(coder);
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, cellsOfLayer(tile.points.size(), layer, tile.layers));
      result.coarse.push_back({tree->frontier().size(), points.spread(tree->frontier())});
    } else {
      tree->finalLayer(coder);
    }
    result.layers.push_back(coder.finish());
  }
  result.order = points.takeOrder();
  result.decoded = points.takeDecoded(parameters.stop.lossy());
  return result;
}

}  // namespace

EncodedTile BspMethod::encode(const TileInput& tile, const PointProgress& progress) const {
  checkTileBounds("bsp", tile, kMaxBits);
  BspParameters parameters;
  parameters.stop = StopRule::of(tile.wishes);
  for (;; ++parameters.slackClass) {
    try {
      return encodeWith(parameters, tile, progress);
    } catch (const BspSortedPoints::Lost&) {
      if (parameters.slackClass == BspParameters::kLastSlackClass) throw;
    }
  }
}

DecodedTile BspMethod::decode(const TileToDecode& tile, const PointProgress& progress) const {
  checkTileBounds("bsp", tile, kMaxBits);
  DecodedTile result;
  BspCollectedPoints points(tile, progress, result);
  const auto tree =
      std::make_unique<Decoding>(tile.extent, points, tile.points, tile.maxDepth, BspParameters());
  for (unsigned layer = 0; layer < tile.payloads.size(); ++layer) {
    entropy::SymbolReader coder(tile.payloads[layer]);
    if (layer == 0) tree->head(coder);
    if (layer + 1 < tile.layers) {
      tree->coarseLayer(coder, 0);
      if (tile.cellLevel == layer) {
        std::uint64_t id = 0;
        for (BspCell& cell : tree->frontier()) cell.id = id++;
      }
    } else {
      tree->finalLayer(coder);
    }
    coder.finish();
  }
  if (tile.payloads.size() < tile.layers) {
    for (const BspCell& cell : tree->frontier()) {
      points.output().representative(cell.box.middle(), cell.count, cell.id);
    }
  }
  return result;
}

}  // namespace bspc::geometry
