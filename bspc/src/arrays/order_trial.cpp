#include "arrays/order_trial.h"

#include <algorithm>

#include "arrays/array_wishes.h"
#include "attributes/array_coder.h"
#include "attributes/order_coder.h"
#include "attributes/tile_points.h"
#include "geometry/fast/tile_sequence.h"

namespace bspc {

namespace {

/// Consecutive points of the input that are tried.
constexpr std::size_t kSample = std::size_t{1} << 14;
/// The sample may be better than the whole.
constexpr double kAllowance = 1.05;

/// Points of the sample in an order like that in which a tile's are decoded.
struct Sample {
  std::vector<GridPoint> points;
  std::vector<std::uint32_t> order;    ///< place of each in the input
  std::vector<std::uint64_t> sources;  ///< input index of each
};

Sample takeSample(Span<const GridPoint> points, const std::vector<std::uint64_t>& sources) {
  const std::size_t count = std::min(points.size(), kSample);
  const std::size_t first = (points.size() - count) / 2;
  std::vector<GridPoint> given(points.begin() + first, points.begin() + first + count);
  GridPoint lower = given[0];
  GridPoint upper = given[0];
  for (const GridPoint& p : given) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], p[k]);
      upper[k] = std::max(upper[k], p[k]);
    }
  }
  GridPoint extent{};
  for (std::size_t k = 0; k < 3; ++k) extent[k] = upper[k] - lower[k];
  for (GridPoint& p : given) {
    for (std::size_t k = 0; k < 3; ++k) p[k] -= lower[k];
  }
  Sample sample;
  sample.order = geometry::fast::hilbertSequence(given, extent);
  for (const std::uint32_t i : sample.order) {
    sample.points.push_back(given[i]);
    sample.sources.push_back(sources.empty() ? first + i : sources[first + i]);
  }
  return sample;
}

}  // namespace

bool storedOrderPays(Span<const GridPoint> points, const std::vector<std::uint64_t>& sources,
                     const ArraySource& arrays, unsigned effort) {
  if (points.empty()) return false;
  const Sample sample = takeSample(points, sources);
  attributes::TilePoints without(sample.points);
  attributes::TilePoints with(sample.points);
  with.setInputOrder(sample.order);
  double saved = 0;
  for (std::size_t a = arrays.hidden(); a < arrays.size(); ++a) {
    const attributes::ArrayWishes wishes = wishesFor(arrays.description(a), effort);
    attributes::ArrayValues values = arrays.gather(a, sample.sources);
    attributes::ArrayValues same = values;
    const attributes::EncodedArray ordered =
        attributes::encodeArray(arrays.shape(a), values, with, wishes);
    if (!ordered.usesInputOrder) continue;
    const attributes::EncodedArray plain =
        attributes::encodeArray(arrays.shape(a), same, without, wishes);
    saved +=
        static_cast<double>(plain.payload.size()) - static_cast<double>(ordered.payload.size());
  }
  if (saved <= 0) return false;
  const Bytes order = attributes::encodeOrder(sample.points, sample.order);
  return saved > kAllowance * static_cast<double>(order.size());
}

}  // namespace bspc
