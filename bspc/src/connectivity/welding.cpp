#include "connectivity/welding.h"

#include <algorithm>
#include <numeric>

namespace bspc::connectivity {

Welding::Welding(Span<const GridPoint> points) : vertexOf_(points.size()), placeOf_(points.size()) {
  std::vector<std::uint32_t> sorted(points.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  // The first point of each place, for every point.
  std::vector<std::uint32_t> leader(points.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool same = i > 0 && points[sorted[i]] == points[sorted[i - 1]];
    leader[sorted[i]] = same ? leader[sorted[i - 1]] : sorted[i];
  }
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    vertexOf_[i] = leader[i] == i ? next++ : vertexOf_[leader[i]];
  }
  firsts_.assign(std::size_t{next} + 1, 0);
  for (const std::uint32_t vertex : vertexOf_) ++firsts_[vertex + 1];
  for (std::uint32_t v = 0; v < next; ++v) firsts_[v + 1] += firsts_[v];
  members_.resize(points.size());
  std::vector<std::uint32_t> fill(firsts_.begin(), firsts_.end() - 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    placeOf_[i] = fill[vertexOf_[i]]++;
    members_[placeOf_[i]] = i;
  }
}

}  // namespace bspc::connectivity
