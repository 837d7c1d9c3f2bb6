#include "box_filter.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "point_selection.h"

namespace bspc {

namespace {

constexpr std::uint64_t kIndices = std::uint64_t{1} << 32;

/// The first index for which `holds` is true, kIndices if none; once true, it stays so.
template <class Predicate>
std::uint64_t firstIndex(Predicate holds) {
  std::uint64_t from = 0;
  std::uint64_t to = kIndices;
  while (from < to) {
    const std::uint64_t middle = from + (to - from) / 2;
    if (holds(static_cast<std::uint32_t>(middle))) {
      to = middle;
    } else {
      from = middle + 1;
    }
  }
  return from;
}

}  // namespace

BoxFilter::BoxFilter(const Grid& grid, const Box& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double lower = box.lower[k];
    const double upper = box.upper[k];
    if (!(lower <= upper)) {  // NaN among them
      throw Error(
          ErrorCode::InvalidArgument,
          std::string("a box needs a lower bound that is not above the upper one, unlike ") +
              std::to_string(lower) + " and " + std::to_string(upper) + " along " + "xyz"[k]);
    }
    const int axis = static_cast<int>(k);
    const std::uint64_t first =
        firstIndex([&](std::uint32_t i) { return restoredCoordinate(grid, axis, i) >= lower; });
    const std::uint64_t end =
        firstIndex([&](std::uint32_t i) { return restoredCoordinate(grid, axis, i) > upper; });
    if (first >= end) {
      empty_ = true;
      continue;
    }
    first_[k] = static_cast<std::uint32_t>(first);
    last_[k] = static_cast<std::uint32_t>(end - 1);
  }
}

bool BoxFilter::touches(const GridPoint& lower, const GridPoint& upper) const {
  bool touching = !empty_;
  for (std::size_t k = 0; k < 3; ++k) {
    touching = touching && first_[k] <= upper[k] && lower[k] <= last_[k];
  }
  return touching;
}

void BoxFilter::apply(DecodedPoints& points) const {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (contains(points.points[i])) kept.push_back(i);
  }
  keepPoints(points, kept);
}

}  // namespace bspc
