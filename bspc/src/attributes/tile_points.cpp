#include "attributes/tile_points.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "bspc/error.h"

namespace bspc::attributes {

namespace {

constexpr unsigned kNearLimit = 8;
constexpr unsigned kNearMean = 3;
constexpr unsigned kWideLimit = 20;
constexpr unsigned kWideMean = 6;

}  // namespace

TilePoints::TilePoints(Span<const GridPoint> points, std::size_t known)
    : points_(points), known_(known) {
  if (known > points.size() || points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::InvalidArgument,
                "arrays are coded for at most 4,294,967,295 points a tile, and known points are "
                "among them");
  }
}

void TilePoints::setInputOrder(Span<const std::uint32_t> order) {
  if (order.size() != added()) {
    throw Error(ErrorCode::InvalidArgument, "an order of " + std::to_string(order.size()) +
                                                " indices was given for " +
                                                std::to_string(added()) + " points");
  }
  inputSequence_.resize(order.size());
  std::iota(inputSequence_.begin(), inputSequence_.end(), 0U);
  const auto before = [&order](std::uint32_t a, std::uint32_t b) { return order[a] < order[b]; };
  const std::uint64_t last = order.empty() ? 0 : *std::max_element(order.begin(), order.end());
  if (last < order.size()) {
    // A permutation: each index says where its point stands.
    for (std::uint32_t j = 0; j < order.size(); ++j) inputSequence_[order[j]] = j;
  } else {
    std::sort(inputSequence_.begin(), inputSequence_.end(), before);
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && !before(inputSequence_[i - 1], inputSequence_[i])) {
      throw Error(ErrorCode::InvalidArgument, "two points have the same place in the input");
    }
  }
  for (std::uint32_t& index : inputSequence_) index += static_cast<std::uint32_t>(known_);
}

const RankedPoints& TilePoints::ranked(MemoryBudget& budget) {
  if (!ranked_) {
    constexpr std::uint64_t kBytes = 4 + 12 + 4 + 2 * sizeof(MortonEntry);
    budget.take(size(), kBytes);
    ranked_ = rankPoints(points_, known_);
  }
  return *ranked_;
}

const NeighbourTable& TilePoints::neighbours(unsigned limit, MemoryBudget& budget) {
  const bool wide = limit > kNearLimit;
  std::optional<NeighbourTable>& table = wide ? wide_ : near_;
  if (!table) {
    const RankedPoints& points = ranked(budget);
    const unsigned kept = wide ? kWideLimit : kNearLimit;
    budget.take(1, NeighbourTable::bytesFor(size(), kept));
    table.emplace(points, kept, wide ? kWideMean : kNearMean);
  }
  return *table;
}

const WindowTable& TilePoints::window(MemoryBudget& budget) {
  if (!window_) {
    budget.take(1, WindowTable::bytesFor(added()));
    window_.emplace(points_.subspan(known_, added()));
  }
  return *window_;
}

Span<const std::uint32_t> TilePoints::decodedSequence(MemoryBudget& budget) {
  if (decodedSequence_.empty()) {
    budget.take(added(), sizeof(std::uint32_t));
    decodedSequence_.resize(added());
    std::iota(decodedSequence_.begin(), decodedSequence_.end(), static_cast<std::uint32_t>(known_));
  }
  return decodedSequence_;
}

}  // namespace bspc::attributes
