#include "bspc/encoder.h"

#include <string>
#include <utility>

#include "bspc/error.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "progress_scale.h"
#include "set_encoder.h"
#include "shared_progress.h"

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

void refuseUnstored(const EncodeOptions& options) {
  if (!options.keepOrder && !options.originalIds && options.metadata.empty()) return;
  throw Error(ErrorCode::Unsupported,
              "this version stores neither the order of the points nor metadata; leave them out");
}

}  // namespace

EncodeReport encode(const PointSetView& points, ByteSink& sink, const EncodeOptions& options) {
  refuseArrays(points);
  refuseUnstored(options);
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
  report.layout = options.layout;
  report.grid = fit.grid;
  report.points = fit.points.size();
  report.dropped = fit.dropped;
  report.exact = fit.exact;
  report.maxError = fit.maxError;
  report.layers = plan.layers;

  ProgressScale coding(options.progress, kGridShare, 1);
  coding.report(0);
  container::ContainerWriter writer(sink, options.layout, report.grid, report.layers);
  SharedProgress progress(coding, report.points);
  SetEncoder(plan, options, progress, writer, report).encode(fit.points, fit.sourceIndex, &points);
  writer.finish();
  report.fileBytes = writer.bytesWritten();
  coding.report(1);
  return report;
}

}  // namespace bspc
