#include "geometry/predictive/depth_classes.h"

#include <algorithm>

namespace bspc::geometry::predictive {

namespace {

constexpr std::size_t kLeastPoints = 4000;
constexpr std::uint32_t kMaxExtent = (1U << 20) - 1;
constexpr std::size_t kLeastClasses = 16;
constexpr std::size_t kMaxClasses = 16384;
constexpr std::size_t kLeastPointsAClass = 20;
constexpr double kLeastPixel = 0.8;  ///< in grid steps

/// How many coordinates of `places` the camera does not explain; stops above `limit`.
std::size_t mismatchesOf(const PinholeCamera& camera, const std::array<double, 2>& size,
                         Span<const DepthClasses::Place> places, std::size_t limit) {
  std::size_t count = 0;
  for (const DepthClasses::Place& place : places) {
    for (unsigned k = 0; k < 2; ++k) {
      const double pixel = camera.pixelAt(k, place[k], size[k]);
      const double position = camera.position(k, static_cast<std::int32_t>(pixel), size[k]);
      if (position != static_cast<double>(place[k])) ++count;
    }
    if (count > limit) break;
  }
  return count;
}

}  // namespace

std::optional<DepthClasses> DepthClasses::of(Span<const GridPoint> points, unsigned axis,
                                             std::uint32_t extent) {
  if (points.size() < kLeastPoints || extent > kMaxExtent) return std::nullopt;
  std::vector<std::uint32_t> counts(std::size_t{extent} + 1, 0);
  for (const GridPoint& p : points) ++counts[p[axis]];
  DepthClasses classes;
  std::size_t next = 0;
  for (std::uint32_t depth = 0; depth <= extent; ++depth) {
    const std::uint32_t count = counts[depth];
    if (count == 0) continue;
    if (classes.depths_.size() == kMaxClasses) return std::nullopt;
    classes.depths_.push_back(depth);
    classes.first_.push_back(next);
    counts[depth] = static_cast<std::uint32_t>(next);
    next += count;
  }
  classes.first_.push_back(next);
  if (classes.size() < kLeastClasses || points.size() / classes.size() < kLeastPointsAClass) {
    return std::nullopt;
  }
  classes.places_.resize(points.size());
  classes.indices_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t at = counts[points[i][axis]]++;
    classes.places_[at] = {points[i][(axis + 1) % 3], points[i][(axis + 2) % 3]};
    classes.indices_[at] = static_cast<std::uint32_t>(i);
  }
  return classes;
}

DepthClasses DepthClasses::sample(std::size_t wanted, std::size_t least) const {
  const std::size_t stride = std::max<std::size_t>(1, points() / wanted);
  DepthClasses part;
  std::size_t skip = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t begin = part.places_.size();
    for (std::size_t j = first_[i]; j < first_[i + 1]; ++j) {
      if (++skip < stride) continue;
      skip = 0;
      part.places_.push_back(places_[j]);
      part.indices_.push_back(indices_[j]);
    }
    if (part.places_.size() - begin < least) {
      part.places_.resize(begin);
      part.indices_.resize(begin);
      continue;
    }
    part.depths_.push_back(depths_[i]);
    part.first_.push_back(begin);
  }
  part.first_.push_back(part.places_.size());
  return part;
}

std::optional<ShiftChoice> chooseShift(const PinholeCamera& camera, std::uint32_t depth,
                                       Span<const DepthClasses::Place> places) {
  constexpr double kMaxPixel = 1e9;
  std::optional<ShiftChoice> best;
  for (int turn = 0; turn <= 2 * PinholeCamera::kMaxShift; ++turn) {
    const int shift = turn % 2 == 0 ? turn / 2 : -(turn + 1) / 2;
    const std::array<double, 2> size = {camera.pixelSize(0, depth, shift),
                                        camera.pixelSize(1, depth, shift)};
    const bool usable = size[0] > kLeastPixel && size[1] > kLeastPixel && size[0] < kMaxPixel &&
                        size[1] < kMaxPixel;
    if (!usable) continue;
    const std::size_t limit = best ? best->mismatches : 2 * places.size();
    const std::size_t mismatches = mismatchesOf(camera, size, places, limit);
    if (!best || mismatches < best->mismatches) best = ShiftChoice{shift, mismatches};
    if (mismatches == 0) break;
  }
  return best;
}

}  // namespace bspc::geometry::predictive
