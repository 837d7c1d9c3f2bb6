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

/// Share of the time that coding one way takes, where two are tried.
constexpr double kOneWayShare = 0.5 * (1 - kGridShare);

/// Writes files of one point set, once it is on its grid.
class FileEncoder {
 public:
  FileEncoder(const PointSetView& points, const GridFit& fit, const EncodeOptions& options,
              const MeshEncoder& mesh)
      : points_(points), fit_(fit), options_(options), mesh_(mesh) {}

  EncodeReport encode(const CodingPlan& plan, ByteSink& sink, double from, double to) const {
    EncodeReport report = start(plan);
    ProgressScale coding(options_.progress, from, to);
    coding.report(0);
    std::vector<ArrayView> views(points_.arrays().begin(), points_.arrays().end());
    std::vector<GridPoint> halves;
    const bool hasHalves = lattice::hasLowHalves(report.grid);
    if (hasHalves) {
      halves = lowHalvesOf(points_);
      views.insert(views.begin(), lowHalvesView(halves));
    }
    const ArraySource arrays(views, hasHalves ? 1 : 0, options_.originalIds);
    container::FileHead head = beginFile(arrays, options_, report);
    head.mesh = mesh_.record();
    container::ContainerWriter writer(sink, options_.layout, std::move(head));
    SharedProgress progress(coding, report.points);
    EncodeOptions pointOptions = options_;
    pointOptions.wantOrder = options_.wantOrder || mesh_.hasWork();
    SetEncoder set(plan, pointOptions, arrays, progress, writer, report);
    set.encode(fit_.points, fit_.sourceIndex, &points_);
    writer.finish([&](std::size_t /*block*/) {
      if (options_.keepOrder) report.order = keptOrder(fit_);
      const Cells* surface = plan.wishes.faces != nullptr ? &set.faces() : nullptr;
      return mesh_.encode(fit_, plan.arrayEffort, report.tiles, surface, report.order, report);
    });
    if (!options_.wantOrder) report.order = {};
    report.fileBytes = writer.bytesWritten();
    coding.report(1);
    return report;
  }

  /// Both ways in memory; the shorter file is written.
  EncodeReport encodeShorter(const CodingPlan& plan, const CodingPlan& other,
                             ByteSink& sink) const {
    MemorySink one;
    MemorySink two;
    constexpr double kMiddle = kGridShare + kOneWayShare;
    const EncodeReport first = encode(plan, one, kGridShare, kMiddle);
    const EncodeReport second = encode(other, two, kMiddle, 1);
    const bool shorter = second.fileBytes < first.fileBytes;
    sink.write((shorter ? two : one).bytes());
    return shorter ? second : first;
  }

 private:
  EncodeReport start(const CodingPlan& plan) const {
    EncodeReport report;
    report.method = plan.method->id();
    report.layout = options_.layout;
    report.grid = fit_.grid;
    report.points = fit_.points.size();
    report.dropped = fit_.dropped;
    report.exact = fit_.exact;
    report.maxError = fit_.maxError;
    report.layers = plan.layers;
    return report;
  }

  const PointSetView& points_;
  const GridFit& fit_;
  const EncodeOptions& options_;
  const MeshEncoder& mesh_;
};

/// Whether method surface can go along the faces of the set and is to: it needs all points in one
/// tile and in an order of its own. Coarse layers are worth more than a shorter file, and another
/// method that was named is meant.
bool mayFollowFaces(const CodingPlan& plan, const EncodeOptions& options, std::uint64_t points) {
  if (points == 0 || points > plan.tilePoints || options.keepOrder) return false;
  const Method method = plan.method->id();
  return method == Method::Surface ||
         (method == Method::Predictive && !options.method && plan.layers == 1);
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
  const FileEncoder file(points, fit, options, mesh);
  if (!mesh.hasWork() || !mayFollowFaces(plan, options, fit.points.size())) {
    return file.encode(plan, sink, kGridShare, 1);
  }
  const Cells faces = mesh.surface(keptOrder(fit));
  CodingPlan along = plan;
  along.method = geometry::findGeometryMethod(Method::Surface);
  along.wishes.faces = &faces;
  if (faces.empty()) return file.encode(plan, sink, kGridShare, 1);
  if (plan.method == along.method) return file.encode(along, sink, kGridShare, 1);
  return file.encodeShorter(plan, along, sink);
}

}  // namespace bspc
