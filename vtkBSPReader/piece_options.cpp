#include "vtkBSPReader/piece_options.h"

#include <algorithm>

namespace bspc::vtk {

TileRange tilesOfPiece(const FileInfo& info, std::uint64_t piece, std::uint64_t pieces) {
  double total = 0;
  for (const TileInfo& tile : info.tiles) total += static_cast<double>(tile.points);
  TileRange range;
  double before = 0;
  for (const TileInfo& tile : info.tiles) {
    // A tile belongs to the piece that its middle point lies in.
    const double middle = before + static_cast<double>(tile.points) / 2;
    before += static_cast<double>(tile.points);
    const double place = total > 0 ? middle / total * static_cast<double>(pieces) : 0;
    const std::uint64_t owner = std::min(static_cast<std::uint64_t>(place), pieces - 1);
    if (owner < piece) ++range.first;
    if (owner == piece) ++range.count;
  }
  return range;
}

DecodeOptions optionsOfPiece(const Decoder& decoder, DecodeOptions whole, std::uint64_t piece,
                             std::uint64_t pieces) {
  if (pieces <= 1) return whole;
  const QueryCost cost = decoder.cost(whole);
  const TileRange tiles = tilesOfPiece(decoder.info(), piece, pieces);
  const std::optional<std::uint64_t> maxPoints = whole.maxPoints;
  whole.level = cost.level;
  whole.maxPoints.reset();
  if (maxPoints && cost.points > *maxPoints) {
    // Even the coarsest level is too large. Shares are cut where pieces meet, so that they add up.
    const auto shareUpTo = [&](std::uint64_t tileCount) {
      whole.tiles = TileRange{0, tileCount};
      const auto points = static_cast<double>(decoder.cost(whole).points);
      return static_cast<std::uint64_t>(points / static_cast<double>(cost.points) *
                                        static_cast<double>(*maxPoints));
    };
    whole.maxPoints = shareUpTo(tiles.first + tiles.count) - shareUpTo(tiles.first);
  }
  whole.tiles = tiles;
  return whole;
}

}  // namespace bspc::vtk
