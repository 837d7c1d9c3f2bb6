#include "coding_plan.h"

#include <algorithm>
#include <string>

#include "bspc/error.h"

namespace bspc {

namespace {

/// Below this a file has one layer: it is on the screen at once anyway.
constexpr std::uint64_t kLayeredPoints = 4096;
/// The coarsest layer of a larger one has about so many representatives.
constexpr std::uint64_t kCoarsestPoints = 256;
/// A tile is addressed by 32-bit indices.
constexpr std::uint64_t kMaxTilePoints = 0xFFFFFFFF;

unsigned chooseLayers(std::uint64_t points, unsigned wished) {
  if (wished != 0) return wished;
  if (points < kLayeredPoints) return 1;
  // Each layer has a quarter of the next one's representatives.
  unsigned layers = 1;
  while ((points >> (2 * layers)) >= kCoarsestPoints && layers < kMaxLayers) ++layers;
  return layers;
}

}  // namespace

CodingPlan planCoding(const EncodeOptions& options, std::uint64_t points) {
  if (options.layers > kMaxLayers) {
    throw Error(ErrorCode::InvalidArgument, std::to_string(options.layers) +
                                                " layers were asked for; a file has at most " +
                                                std::to_string(kMaxLayers));
  }
  CodingPlan plan;
  const Method id = options.method.value_or(Method::Kd);
  plan.method = geometry::findGeometryMethod(id);
  if (plan.method == nullptr) {
    throw Error(ErrorCode::InvalidArgument,
                "this version has no method number " + std::to_string(static_cast<int>(id)));
  }
  if ((options.stopPoints > 0 || options.stopLevel) && !plan.method->canStop()) {
    throw Error(ErrorCode::InvalidArgument, std::string("method ") + methodName(id) +
                                                " has no lossy stops; the methods bsp and kd have");
  }
  plan.wishes.stopPoints = options.stopPoints;
  plan.wishes.stopLevel = options.stopLevel;
  const std::uint64_t wished = options.tilePoints != 0 ? options.tilePoints : kMaxTilePoints;
  plan.tilePoints = std::min(wished, kMaxTilePoints);
  plan.layers = chooseLayers(std::min(points, plan.tilePoints), options.layers);
  return plan;
}

}  // namespace bspc
