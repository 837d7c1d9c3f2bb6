#include "geometry/bsp/bsp_points.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/bsp/cut_choice.h"

namespace bspc::geometry {

namespace {

constexpr std::uint64_t kProgressStep = 1U << 14;

std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

}  // namespace

BspSortedPoints::BspSortedPoints(const TileInput& tile, const PointProgress& progress)
    : progress_(progress),
      lossy_(StopRule::of(tile.wishes).lossy()),
      points_(tile.points.begin(), tile.points.end()),
      order_(tile.points.size()) {
  for (GridPoint& p : points_) {
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
  }
  std::iota(order_.begin(), order_.end(), 0U);
}

std::uint64_t BspSortedPoints::partition(const BspCell& cell, const CutPlane& plane) {
  std::size_t low = static_cast<std::size_t>(cell.first);
  std::size_t high = low + static_cast<std::size_t>(cell.count);
  for (;;) {
    while (low < high && plane.inFront(points_[low])) ++low;
    while (low < high && !plane.inFront(points_[high - 1])) --high;
    if (low == high) return low - cell.first;
    std::swap(points_[low], points_[high - 1]);
    std::swap(order_[low], order_[high - 1]);
  }
}

WantedDirection BspSortedPoints::wantedDirection(const BspCell& cell,
                                                 const LocalFrame& frame) const {
  return geometry::wantedDirection(pointsOf(cell), frame);
}

double BspSortedPoints::wantedAlpha(const BspCell& cell, const LocalFrame& frame,
                                    const IntegerVector& normal) const {
  return geometry::wantedAlpha(pointsOf(cell), frame, normal);
}

void BspSortedPoints::tally(const BspCell& cell, const GridPoint* places, unsigned count,
                            std::uint64_t* points) {
  std::vector<std::pair<unsigned, std::uint32_t>> found;
  const auto first = static_cast<std::size_t>(cell.first);
  for (std::size_t j = first; j < first + cell.count; ++j) {
    const auto place =
        static_cast<unsigned>(std::find(places, places + count, points_[j]) - places);
    if (place == count) lost();
    found.emplace_back(place, order_[j]);
    ++points[place];
  }
  if (found.size() == 1) return;
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < found.size(); ++i) {
    points_[first + i] = places[found[i].first];
    order_[first + i] = found[i].second;
  }
}

void BspSortedPoints::emit(const GridPoint& point, std::uint64_t count, const BspCell& /*cell*/) {
  if (lossy_) decoded_.insert(decoded_.end(), static_cast<std::size_t>(count), point);
  done_ += count;
  if (done_ < nextReport_) return;
  nextReport_ = done_ + kProgressStep;
  if (progress_) progress_(done_);
}

std::uint32_t BspSortedPoints::spread(const std::vector<BspCell>& cells) const {
  std::uint32_t most = 0;
  for (const BspCell& cell : cells) {
    const GridPoint middle = cell.box.middle();
    for (const GridPoint& p : pointsOf(cell)) {
      for (std::size_t k = 0; k < 3; ++k) most = std::max(most, distance(p[k], middle[k]));
    }
  }
  return most;
}

}  // namespace bspc::geometry
