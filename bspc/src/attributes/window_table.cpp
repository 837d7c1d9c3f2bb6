#include "attributes/window_table.h"

#include <algorithm>
#include <cstdlib>

#include "attributes/morton.h"

namespace bspc::attributes {

namespace {

/// Coordinates are cut to so many bits that the sum of three differences and a place fit 31.
constexpr unsigned kCoordinateBits = 25;
constexpr unsigned kPlaceBits = 4;
static_assert(WindowTable::kWindow == 1U << kPlaceBits);

using Axes = std::array<std::vector<std::int32_t>, 3>;

Axes axesOf(Span<const GridPoint> points) {
  const unsigned bits = coordinateBits(points);
  const unsigned cut = bits > kCoordinateBits ? bits - kCoordinateBits : 0;
  Axes axes;
  for (unsigned k = 0; k < 3; ++k) {
    axes[k].resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      axes[k][i] = static_cast<std::int32_t>(points[i][k] >> cut);
    }
  }
  return axes;
}

/// Points that are searched for together, so that compilers can do several at a time.
constexpr std::size_t kBlock = 64;

constexpr std::int32_t kNone = 0x7FFFFFFF;

/// The three least keys of each point of a block, in order. A key is a distance and, below it, how
/// many points stand between.
struct LeastKeys {
  std::array<std::array<std::int32_t, kBlock>, WindowTable::kNeighbours> keys;

  LeastKeys() {
    for (auto& row : keys) row.fill(kNone);
  }

  void offer(std::size_t b, std::int32_t key) {
    const std::int32_t second = std::max(keys[0][b], key);
    keys[0][b] = std::min(keys[0][b], key);
    const std::int32_t third = std::max(keys[1][b], second);
    keys[1][b] = std::min(keys[1][b], second);
    keys[2][b] = std::min(keys[2][b], third);
  }

  /// Offers the points `step` places before those of the block that starts at `first`.
  void offerStep(const Axes& axes, std::size_t first, std::size_t count, std::int32_t step) {
    const std::int32_t* x = axes[0].data() + first;
    const std::int32_t* y = axes[1].data() + first;
    const std::int32_t* z = axes[2].data() + first;
    for (std::size_t b = 0; b < count; ++b) {
      const std::int32_t* x1 = x + b;
      const std::int32_t* y1 = y + b;
      const std::int32_t* z1 = z + b;
      const std::int32_t distance = std::abs(*x1 - *(x1 - step)) + std::abs(*y1 - *(y1 - step)) +
                                    std::abs(*z1 - *(z1 - step));
      offer(b, distance << kPlaceBits | (step - 1));
    }
  }
};

}  // namespace

WindowTable::WindowTable(Span<const GridPoint> points) : steps_(points.size()) {
  const Axes axes = axesOf(points);
  const auto store = [this](std::size_t i, const LeastKeys& least, std::size_t b) {
    for (unsigned n = 0; n < kNeighbours; ++n) {
      const std::int32_t key = least.keys[n][b];
      steps_[i][n] = key != kNone
                         ? static_cast<std::uint8_t>(key % static_cast<std::int32_t>(kWindow) + 1)
                         : steps_[i][n - 1];
    }
  };
  // The first points have fewer before them.
  const std::size_t full = std::min<std::size_t>(points.size(), kWindow);
  for (std::size_t i = 1; i < full; ++i) {
    LeastKeys least;
    for (std::size_t step = 1; step <= i; ++step) {
      least.offerStep(axes, i, 1, static_cast<std::int32_t>(step));
    }
    store(i, least, 0);
  }
  for (std::size_t first = full; first < points.size(); first += kBlock) {
    LeastKeys least;
    const std::size_t count = std::min(kBlock, points.size() - first);
    for (std::int32_t step = 1; step <= static_cast<std::int32_t>(kWindow); ++step) {
      if (count == kBlock) {
        least.offerStep(axes, first, kBlock, step);
      } else {
        least.offerStep(axes, first, count, step);
      }
    }
    for (std::size_t b = 0; b < count; ++b) store(first + b, least, b);
  }
}

}  // namespace bspc::attributes
