#include "cli/nearest_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bspc::cli {

namespace {

using Point = std::array<double, 3>;

double square(double v) { return v * v; }

double squaredDistance(const Point& a, const Point& b) {
  return square(a[0] - b[0]) + square(a[1] - b[1]) + square(a[2] - b[2]);
}

/// Searches outwards from where `p` would stand among points that are sorted along `axis`. A point
/// that is nearer than `enough` ends the search: it cannot be what is asked for.
double nearest(const Point& p, const std::vector<Point>& sorted, std::size_t axis, double enough) {
  const auto before = [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; };
  auto up = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), p, before) -
                                     sorted.begin());
  std::size_t down = up;
  double best = std::numeric_limits<double>::infinity();
  while (best > enough) {
    const double above = up < sorted.size() ? square(sorted[up][axis] - p[axis])
                                            : std::numeric_limits<double>::infinity();
    const double below = down > 0 ? square(sorted[down - 1][axis] - p[axis])
                                  : std::numeric_limits<double>::infinity();
    if (std::min(above, below) >= best) break;
    best = std::min(best, squaredDistance(p, above <= below ? sorted[up++] : sorted[--down]));
  }
  return best;
}

}  // namespace

double greatestDistanceToNearest(const std::vector<Point>& from, std::vector<Point> to) {
  std::array<double, 3> extent{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax_element(
        to.begin(), to.end(), [k](const Point& a, const Point& b) { return a[k] < b[k]; });
    extent[k] = (*most)[k] - (*least)[k];
  }
  const auto axis =
      static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  std::sort(to.begin(), to.end(),
            [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
  double greatest = 0;
  for (const Point& p : from) greatest = std::max(greatest, nearest(p, to, axis, greatest));
  return std::sqrt(greatest);
}

}  // namespace bspc::cli
