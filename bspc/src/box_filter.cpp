#include "box_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "grid/float_grid.h"
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

BoxFilter::BoxFilter(const Grid& grid, const Box& box)
    : box_(box), halved_(lattice::hasLowHalves(grid)) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double lower = box.lower[k];
    const double upper = box.upper[k];
    if (!(lower <= upper)) {  // NaN among them
      throw Error(
          ErrorCode::InvalidArgument,
          std::string("a box needs a lower bound that is not above the upper one, unlike ") +
              std::to_string(lower) + " and " + std::to_string(upper) + " along " + "xyz"[k]);
    }
    if (lattice::isFloatGrid(grid)) {
      setFloatRange(grid, k);
      continue;
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

/// The indices whose coordinates can lie in the box; both bounds are numbers, maybe infinite.
void BoxFilter::setFloatRange(const Grid& grid, std::size_t axis) {
  const lattice::OrderRange finite = lattice::finiteMultiples(grid.scalarType);
  const std::int64_t base = grid.axes[axis].base;
  // The first multiple that a predicate holds for, among the finite ones and what lies behind them.
  const auto firstMultiple = [&](auto holds) {
    std::int64_t from = finite.first;
    std::int64_t to = std::int64_t{finite.last} + 1;
    while (from < to) {
      const std::int64_t middle = from + (to - from) / 2;
      const auto k = static_cast<std::uint32_t>(middle);
      if (holds(k)) {
        to = middle;
      } else {
        from = middle + 1;
      }
    }
    return from;
  };
  constexpr std::uint32_t kHighest = 0xFFFFFFFF;
  const auto greatest = [&](std::uint32_t k) {
    return halved_ ? lattice::doubleOfHalves(k, kHighest) : double{lattice::floatOfOrder(k)};
  };
  const auto least = [&](std::uint32_t k) {
    return halved_ ? lattice::doubleOfHalves(k, 0) : double{lattice::floatOfOrder(k)};
  };
  const double lower = box_.lower[axis];
  const double upper = box_.upper[axis];
  const std::int64_t first = firstMultiple([&](std::uint32_t k) { return greatest(k) >= lower; });
  const std::int64_t end = firstMultiple([&](std::uint32_t k) { return least(k) > upper; });
  constexpr std::int64_t kLast = kIndices - 1;
  if (first >= end || end - 1 < base || first > base + kLast) {
    empty_ = true;
    return;
  }
  bases_[axis] = static_cast<std::uint32_t>(base);
  first_[axis] = static_cast<std::uint32_t>(std::max(first - base, std::int64_t{0}));
  last_[axis] = static_cast<std::uint32_t>(std::min(end - 1 - base, kLast));
}

bool BoxFilter::holds(const GridPoint& p, const GridPoint& lowHalves) const {
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = lattice::doubleOfHalves(bases_[k] + p[k], lowHalves[k]);
    inside = inside && box_.lower[k] <= x && x <= box_.upper[k];
  }
  return inside;
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
    const bool inside = points.lowHalves.empty() ? contains(points.points[i])
                                                 : contains(points.points[i], points.lowHalves[i]);
    if (inside) kept.push_back(i);
  }
  keepPoints(points, kept);
}

}  // namespace bspc
