#include "bspc/encoder.h"

#include <algorithm>
#include <limits>
#include <string>

#include "bspc/error.h"
#include "container/checksum.h"
#include "container/container_writer.h"
#include "geometry/geometry_method.h"
#include "progress_scale.h"

namespace bspc {

namespace {

/// Below this a file has one layer: it is on the screen at once anyway.
constexpr std::uint64_t kLayeredPoints = 4096;
/// The coarsest layer of a larger one has about so many representatives.
constexpr std::uint64_t kCoarsestPoints = 256;
/// Share of the time that putting points on the grid takes.
constexpr double kGridShare = 0.15;

void checkOptions(const PointSetView& points, const EncodeOptions& options) {
  if (!points.arrays().empty()) {
    throw Error(ErrorCode::Unsupported, "the point set has the array \"" + points.arrays()[0].name +
                                            "\", and this version stores positions only; leave "
                                            "the arrays out to store the positions");
  }
  if (options.layers > kMaxLayers) {
    throw Error(ErrorCode::InvalidArgument, std::to_string(options.layers) +
                                                " layers were asked for; a file has at most " +
                                                std::to_string(kMaxLayers));
  }
}

unsigned chooseLayers(std::uint64_t points, unsigned wished) {
  if (wished != 0) return wished;
  if (points < kLayeredPoints) return 1;
  // Each layer has a quarter of the next one's representatives.
  unsigned layers = 1;
  while ((points >> (2 * layers)) >= kCoarsestPoints && layers < kMaxLayers) ++layers;
  return layers;
}

geometry::TileInput wholeTile(const GridFit& fit, unsigned layers) {
  geometry::TileInput tile;
  tile.points = fit.points;
  tile.layers = layers;
  if (fit.points.empty()) return tile;
  GridPoint upper{};
  tile.lower.fill(std::numeric_limits<std::uint32_t>::max());
  for (const GridPoint& p : fit.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      tile.lower[k] = std::min(tile.lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = upper[k] - tile.lower[k];
  return tile;
}

std::uint64_t checksumInOrder(const geometry::TileInput& tile,
                              const std::vector<std::uint32_t>& order) {
  std::vector<GridPoint> decoded;
  decoded.reserve(order.size());
  for (const std::uint32_t i : order) {
    GridPoint p = tile.points[i];
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    decoded.push_back(p);
  }
  return container::contentChecksum(decoded);
}

void addTile(container::ContainerWriter& writer, const geometry::TileInput& tile,
             const geometry::GeometryMethod& method, geometry::EncodedTile coded,
             EncodeReport& report) {
  container::TileRecord record;
  record.method = static_cast<unsigned>(method.id());
  record.version = method.version();
  record.points = tile.points.size();
  record.lower = tile.lower;
  record.extent = tile.extent;
  record.coarse = std::move(coded.coarse);
  record.contentChecksum = checksumInOrder(tile, coded.order);
  for (const Bytes& layer : coded.layers) report.geometryBytes += layer.size();
  writer.addTile(std::move(record), std::move(coded.layers));
  ++report.tiles;
}

}  // namespace

EncodeReport encode(const PointSetView& points, ByteSink& sink, const EncodeOptions& options) {
  checkOptions(points, options);
  EncodeReport report;
  report.method = options.method.value_or(Method::Kd);
  const geometry::GeometryMethod* method = geometry::findGeometryMethod(report.method);
  if (method == nullptr) {
    throw Error(ErrorCode::InvalidArgument, "this version has no method number " +
                                                std::to_string(static_cast<int>(report.method)));
  }

  ProgressScale fitting(options.progress, 0, kGridShare);
  const ProgressCallback fittingProgress = [&fitting](double share) {
    fitting.report(share);
    return true;
  };
  GridFit fit = fitGrid(points, options.grid, fittingProgress);
  report.grid = fit.grid;
  report.points = fit.points.size();
  report.dropped = fit.dropped;
  report.exact = fit.exact;
  report.maxError = fit.maxError;
  report.layers = chooseLayers(report.points, options.layers);

  ProgressScale coding(options.progress, kGridShare, 1);
  const auto total = static_cast<double>(report.points);
  const geometry::PointProgress progress = [&coding, total](std::uint64_t done) {
    coding.report(static_cast<double>(done) / total);
  };
  coding.report(0);
  container::ContainerWriter writer(sink, options.layout, report.grid, report.layers);
  if (report.points > 0) {
    const geometry::TileInput tile = wholeTile(fit, report.layers);
    geometry::EncodedTile coded = method->encode(tile, progress);
    if (options.wantOrder) {
      report.order.assign(coded.order.begin(), coded.order.end());
      if (!fit.sourceIndex.empty()) {
        for (std::uint64_t& i : report.order) i = fit.sourceIndex[i];
      }
    }
    addTile(writer, tile, *method, std::move(coded), report);
  }
  writer.finish();
  report.fileBytes = writer.bytesWritten();
  coding.report(1);
  return report;
}

}  // namespace bspc
