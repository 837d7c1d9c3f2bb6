#include "coding_plan.h"

#include <algorithm>
#include <array>
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
/// Tiles of method fast: small enough for the cache and for boxes, large enough to learn from.
constexpr std::uint64_t kFastTilePoints = 65536;
/// Up to here a set is one tile: its file is read in a moment, and what tiles learn apart from each
/// other costs up to 4 % (measured on scans with coordinates on uneven grids).
constexpr std::uint64_t kOneFastTile = std::uint64_t{1} << 19;
/// Tiles of method predictive learn more the larger they are.
constexpr std::uint64_t kPredictiveTilePoints = 2000000;
/// From here on they have four layers, which cost next to nothing, the coarsest with 1/64 of the
/// points.
constexpr std::uint64_t kLayeredPredictivePoints = std::uint64_t{1} << 17;
constexpr unsigned kQuickEffort = 2;
/// Up to here even the greatest effort is over at once.
constexpr std::uint64_t kGreatestEffortPoints = 20000;
/// Microseconds a point that efforts 1 to 9 take, encoding on one core of 2020.
constexpr std::array<double, 9> kMicroseconds{0.15, 0.2, 0.35, 0.5, 5, 7, 9, 13, 16};
constexpr unsigned kMaxFastEffort = 4;  ///< method fast up to here, predictive above
constexpr unsigned kMaxEffort = 9;
/// For methods without a choice, which are for those who want small files.
constexpr unsigned kFullArrayEffort = 6;

/// Each layer has a quarter of the next one's representatives.
unsigned quarteredLayers(std::uint64_t points) {
  if (points < kLayeredPoints) return 1;
  unsigned layers = 1;
  while ((points >> (2 * layers)) >= kCoarsestPoints && layers < kMaxLayers) ++layers;
  return layers;
}

/// Layers of method fast are 128 times smaller than the next: one for a single tile, two for some,
/// three where the coarser of two would still be large.
unsigned fastLayers(std::uint64_t points, std::uint64_t tilePoints) {
  constexpr std::uint64_t kLargeCoarseLayer = std::uint64_t{1} << 16;
  if (points <= tilePoints) return 1;
  return points / 128 <= kLargeCoarseLayer ? 2 : 3;
}

Method methodOfEffort(unsigned effort) {
  return effort <= kMaxFastEffort ? Method::Fast : Method::Predictive;
}

unsigned chooseLayers(const EncodeOptions& options, Method method, std::uint64_t points,
                      std::uint64_t tilePoints) {
  if (options.layers != 0) return options.layers;
  if (method == Method::Fast) return fastLayers(points, tilePoints);
  if (method == Method::Predictive) return points < kLayeredPredictivePoints ? 1 : 4;
  if (method == Method::Surface) return 1;  // its coarse layers show nothing
  return quarteredLayers(std::min(points, tilePoints));
}

std::uint64_t usualTilePoints(Method method, std::uint64_t points) {
  if (method == Method::Predictive) return kPredictiveTilePoints;
  return method == Method::Fast && points > kOneFastTile ? kFastTilePoints : kMaxTilePoints;
}

void checkWishes(const EncodeOptions& options) {
  if (options.layers > kMaxLayers) {
    throw Error(ErrorCode::InvalidArgument, std::to_string(options.layers) +
                                                " layers were asked for; a file has at most " +
                                                std::to_string(kMaxLayers));
  }
  if (options.seconds != 0 && (options.effort || !(options.seconds > 0))) {
    throw Error(ErrorCode::InvalidArgument,
                "a time to be met must be above 0 seconds and stand without an effort");
  }
  if (!options.effort) return;
  if (*options.effort < 1 || *options.effort > kMaxEffort) {
    throw Error(ErrorCode::InvalidArgument, "an effort of " + std::to_string(*options.effort) +
                                                " was asked for; efforts go from 1 to " +
                                                std::to_string(kMaxEffort));
  }
  if (options.method && *options.method != methodOfEffort(*options.effort)) {
    const bool hasEfforts =
        *options.method == Method::Fast || *options.method == Method::Predictive;
    throw Error(ErrorCode::InvalidArgument,
                std::string("method ") + methodName(*options.method) +
                    (hasEfforts ? " does not have the effort " + std::to_string(*options.effort) +
                                      ": 1 to 4 are method fast, 5 to 9 method predictive"
                                : " has no efforts") +
                    "; leave one of the two out");
  }
}

/// The effort that is asked for, or that suits so many points.
unsigned chooseEffort(const EncodeOptions& options, std::uint64_t points) {
  if (options.effort) return *options.effort;
  const auto fits = [&](unsigned effort) {
    const bool allowed = !options.method || *options.method == methodOfEffort(effort);
    const double seconds = kMicroseconds[effort - 1] * 1e-6 * static_cast<double>(points);
    return allowed && seconds <= options.seconds;
  };
  if (options.seconds > 0) {
    unsigned effort = kMaxEffort;
    while (effort > 1 && !fits(effort)) --effort;
    if (options.method == Method::Predictive) return std::max(effort, kMaxFastEffort + 1);
    return effort;
  }
  if (options.method) return *options.method == Method::Predictive ? kMaxEffort : kQuickEffort;
  return points <= kGreatestEffortPoints ? kMaxEffort : kQuickEffort;
}

}  // namespace

CodingPlan planCoding(const EncodeOptions& options, std::uint64_t points) {
  checkWishes(options);
  CodingPlan plan;
  const unsigned effort = chooseEffort(options, points);
  const Method id = options.method.value_or(methodOfEffort(effort));
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
  plan.wishes.effort = effort;
  plan.arrayEffort =
      id == Method::Fast || id == Method::Predictive ? plan.wishes.effort : kFullArrayEffort;
  const std::uint64_t usual = usualTilePoints(id, points);
  plan.tilePoints = std::min(options.tilePoints != 0 ? options.tilePoints : usual, kMaxTilePoints);
  plan.layers = chooseLayers(options, id, points, plan.tilePoints);
  return plan;
}

}  // namespace bspc
