#include "bspc/encoder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "lossy_error.h"
#include "parallel.h"
#include "progress_scale.h"
#include "shared_progress.h"
#include "tile_encoder.h"
#include "tiling/tile_cut.h"

namespace bspc {

namespace {

/// Share of the time that putting points on the grid takes.
constexpr double kGridShare = 0.15;

void refuseArrays(const PointSetView& points) {
  if (points.arrays().empty()) return;
  throw Error(ErrorCode::Unsupported, "the point set has the array \"" + points.arrays()[0].name +
                                          "\", and this version stores positions only; leave "
                                          "the arrays out to store the positions");
}

/// Codes the points of one fit and hands them to a container.
class SetEncoder {
 public:
  SetEncoder(const PointSetView& points, const GridFit& fit, const CodingPlan& plan,
             const EncodeOptions& options, EncodeReport& report)
      : points_(points), fit_(fit), plan_(plan), options_(options), report_(report) {}

  void run(container::ContainerWriter& writer, ProgressScale& scale) {
    const TileEncoder encoder(*plan_.method, plan_.layers, plan_.wishes);
    SharedProgress progress(scale, fit_.points.size());
    // Tiles are addressed by 32-bit indices, so sets beyond that are cut into parts first.
    constexpr std::size_t kPart = std::size_t{1} << 31;
    for (std::size_t first = 0; first < fit_.points.size(); first += kPart) {
      const std::size_t count = std::min(kPart, fit_.points.size() - first);
      runPart(first, Span<const GridPoint>(fit_.points).subspan(first, count), encoder, writer,
              progress);
    }
  }

 private:
  void runPart(std::size_t offset, Span<const GridPoint> points, const TileEncoder& encoder,
               container::ContainerWriter& writer, SharedProgress& progress) {
    const tiling::TileCut cut =
        tiling::cutTiles(points, static_cast<std::size_t>(plan_.tilePoints));
    const auto produce = [&](std::size_t i) {
      const std::size_t count = cut.firsts[i + 1] - cut.firsts[i];
      if (cut.order.empty()) return encoder.encode(points, progress.piece());
      std::vector<GridPoint> tile(count);
      for (std::size_t j = 0; j < count; ++j) tile[j] = points[cut.order[cut.firsts[i] + j]];
      return encoder.encode(tile, progress.piece());
    };
    const auto consume = [&](std::size_t i, FinishedTile tile) {
      for (const Bytes& chunk : tile.chunks) report_.geometryBytes += chunk.size();
      ++report_.tiles;
      if (options_.wantOrder || !tile.decoded.empty()) {
        const std::vector<std::uint64_t> sources = sourcesOf(cut, i, offset, tile.order);
        if (!tile.decoded.empty()) {
          addLossyError(points_, sources, tile.decoded, tile.record.lower, report_);
        }
        if (options_.wantOrder) {
          report_.order.insert(report_.order.end(), sources.begin(), sources.end());
        }
      }
      writer.addTile(std::move(tile.record), std::move(tile.chunks));
    };
    OrderedParallel<FinishedTile>(cut.tiles(), threadCount(options_.threads), produce)
        .run(consume, [&progress] { progress.report(); });
  }

  /// Input indices of a tile's points, in decoded order.
  std::vector<std::uint64_t> sourcesOf(const tiling::TileCut& cut, std::size_t tile,
                                       std::size_t offset,
                                       const std::vector<std::uint32_t>& order) const {
    std::vector<std::uint64_t> sources;
    sources.reserve(order.size());
    for (const std::uint32_t j : order) {
      const std::size_t inPart = cut.firsts[tile] + j;
      const std::size_t index = offset + (cut.order.empty() ? inPart : cut.order[inPart]);
      sources.push_back(fit_.sourceIndex.empty() ? index : fit_.sourceIndex[index]);
    }
    return sources;
  }

  const PointSetView& points_;
  const GridFit& fit_;
  const CodingPlan& plan_;
  const EncodeOptions& options_;
  EncodeReport& report_;
};

}  // namespace

EncodeReport encode(const PointSetView& points, ByteSink& sink, const EncodeOptions& options) {
  refuseArrays(points);
  planCoding(options, points.size());  // wishes that cannot be met are refused before any work
  ProgressScale fitting(options.progress, 0, kGridShare);
  const ProgressCallback fittingProgress = [&fitting](double share) {
    fitting.report(share);
    return true;
  };
  const GridFit fit = fitGrid(points, options.grid, fittingProgress);
  const CodingPlan plan = planCoding(options, fit.points.size());
  EncodeReport report;
  report.method = plan.method->id();
  report.grid = fit.grid;
  report.points = fit.points.size();
  report.dropped = fit.dropped;
  report.exact = fit.exact;
  report.maxError = fit.maxError;
  report.layers = plan.layers;

  ProgressScale coding(options.progress, kGridShare, 1);
  coding.report(0);
  container::ContainerWriter writer(sink, options.layout, report.grid, report.layers);
  SetEncoder(points, fit, plan, options, report).run(writer, coding);
  writer.finish();
  report.fileBytes = writer.bytesWritten();
  coding.report(1);
  return report;
}

}  // namespace bspc
