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

/// Distance and, below it, how many points stand between.
std::int32_t keyOf(const Axes& axes, std::size_t i, std::size_t step) {
  const std::size_t j = i - step;
  const std::int32_t distance = std::abs(axes[0][j] - axes[0][i]) +
                                std::abs(axes[1][j] - axes[1][i]) +
                                std::abs(axes[2][j] - axes[2][i]);
  return distance << kPlaceBits | static_cast<std::int32_t>(step - 1);
}

/// The three least of the keys offered.
struct Least {
  static constexpr std::int32_t kNone = 0x7FFFFFFF;
  std::array<std::int32_t, WindowTable::kNeighbours> keys{kNone, kNone, kNone};

  void offer(std::int32_t key) {
    const std::int32_t second = std::max(keys[0], key);
    keys[0] = std::min(keys[0], key);
    const std::int32_t third = std::max(keys[1], second);
    keys[1] = std::min(keys[1], second);
    keys[2] = std::min(keys[2], third);
  }
};

}  // namespace

WindowTable::WindowTable(Span<const GridPoint> points) : steps_(points.size()) {
  const Axes axes = axesOf(points);
  std::array<std::int32_t, kWindow> keys{};
  for (std::size_t i = 1; i < points.size(); ++i) {
    Least least;
    if (i >= kWindow) {
      for (std::size_t step = 1; step <= kWindow; ++step) keys[step - 1] = keyOf(axes, i, step);
      for (const std::int32_t key : keys) least.offer(key);
    } else {
      for (std::size_t step = 1; step <= i; ++step) least.offer(keyOf(axes, i, step));
    }
    for (unsigned n = 0; n < kNeighbours; ++n) {
      const std::int32_t key = least.keys[n] != Least::kNone ? least.keys[n] : least.keys[n - 1];
      least.keys[n] = key;
      steps_[i][n] = static_cast<std::uint8_t>(key % static_cast<std::int32_t>(kWindow) + 1);
    }
  }
}

}  // namespace bspc::attributes
