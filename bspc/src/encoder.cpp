#include "bspc/encoder.h"

#include <numeric>
#include <string>
#include <utility>

#include "arrays/array_checks.h"
#include "arrays/array_source.h"
#include "arrays/low_halves.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "encoded_head.h"
#include "grid/float_grid.h"
#include "mesh/mesh_encoder.h"
#include "progress_scale.h"
#include "set_encoder.h"
#include "shared_progress.h"

namespace bspc {

namespace {

/// Share of the time that putting points on the grid takes.
constexpr double kGridShare = 0.15;

/// Input indices of the points that are kept, in order.
std::vector<std::uint64_t> keptOrder(const GridFit& fit) {
  std::vector<std::uint64_t> order = fit.sourceIndex;
  if (order.empty()) {
    order.resize(fit.points.size());
    std::iota(order.begin(), order.end(), std::uint64_t{0});
  }
  return order;
}

}  // namespace

EncodeReport encode(const PointSetView& points, ByteSink& sink, const EncodeOptions& options) {
  checkArrays(points.arrays(), points.size(), options);
  const MeshEncoder mesh(points, options);
  checkMetadata(options.metadata);
  planCoding(options, points.size());  // wishes that cannot be met are refused before any work
  ProgressScale fitting(options.progress, 0, kGridShare);
  const ProgressCallback fittingProgress = [&fitting](double share) {
    fitting.report(share);
    return true;
  };
  const GridFit fit = fitGrid(points, options.grid, fittingProgress);
  refuseStopsOnFloats(fit.grid, options);
  const CodingPlan plan = planCoding(options, fit.points.size());
  EncodeReport report;
  report.method = plan.method->id();
  report.layout = options.layout;
  report.grid = fit.grid;
  report.points = fit.points.size();
  report.dropped = fit.dropped;
  report.exact = fit.exact;
  report.maxError = fit.maxError;
  report.layers = plan.layers;

  ProgressScale coding(options.progress, kGridShare, 1);
  coding.report(0);
  std::vector<ArrayView> views(points.arrays().begin(), points.arrays().end());
  std::vector<GridPoint> halves;
  const bool hasHalves = lattice::hasLowHalves(report.grid);
  if (hasHalves) {
    halves = lowHalvesOf(points);
    views.insert(views.begin(), lowHalvesView(halves));
  }
  const ArraySource arrays(views, hasHalves ? 1 : 0, options.originalIds);
  container::FileHead head = beginFile(arrays, options, report);
  head.mesh = mesh.record();
  container::ContainerWriter writer(sink, options.layout, std::move(head));
  SharedProgress progress(coding, report.points);
  EncodeOptions pointOptions = options;
  pointOptions.wantOrder = options.wantOrder || mesh.hasWork();
  SetEncoder(plan, pointOptions, arrays, progress, writer, report)
      .encode(fit.points, fit.sourceIndex, &points);
  writer.finish([&](std::size_t /*block*/) {
    if (options.keepOrder) report.order = keptOrder(fit);
    return mesh.encode(fit, plan.arrayEffort, report.tiles, report.order, report);
  });
  if (!options.wantOrder) report.order = {};
  report.fileBytes = writer.bytesWritten();
  coding.report(1);
  return report;
}

}  // namespace bspc
