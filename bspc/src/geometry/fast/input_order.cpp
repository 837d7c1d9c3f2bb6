#include "geometry/fast/input_order.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "entropy/symbol_coder.h"
#include "geometry/fast/order_coder.h"

namespace bspc::geometry::fast {

namespace {

// The models are too large for the stack of a thread.
using Writing = OrderCoder<entropy::SymbolWriter>;
using Reading = OrderCoder<entropy::SymbolReader>;

}  // namespace

Bytes writeInInputOrder(const RankedPoints& ranked, const LayerStrides& strides, unsigned layer) {
  const auto points = std::make_unique<Writing>(ranked.header().frame.extent);
  entropy::SymbolWriter coder;
  const std::uint64_t count = strides.upTo(layer);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t place = i << strides.strideBits(layer);
    GridPoint p = ranked[place];
    if (strides.isNew(place, layer)) {
      points->code(coder, p);
    } else {
      points->pass(p);
    }
  }
  return coder.finish();
}

void readInInputOrder(ByteView payload, const LayerStrides& strides, unsigned layer,
                      const GridPoint& extent, const TileToDecode& limits,
                      const PointProgress& progress, std::vector<GridPoint>& points) {
  constexpr std::uint64_t kProgressStep = 1U << 16;
  const auto coder = std::make_unique<Reading>(extent);
  const OutputBudget budget(limits);
  entropy::SymbolReader symbols(payload);
  const std::vector<GridPoint> known = std::move(points);
  DecodedTile grown;
  std::size_t nextKnown = 0;
  const std::uint64_t count = strides.upTo(layer);
  for (std::uint64_t i = 0; i < count; ++i) {
    GridPoint p{};
    if (strides.isNew(i << strides.strideBits(layer), layer)) {
      coder->code(symbols, p);
    } else {
      p = known[nextKnown++];
      coder->pass(p);
    }
    budget.beforeAppend(grown);
    if (progress && i % kProgressStep == 0) progress(i);
    grown.points.push_back(p);
  }
  symbols.finish();
  points = std::move(grown.points);
}

double estimateInInputOrder(const RankedPoints& ranked) {
  constexpr std::size_t kWarmUp = 1024;
  constexpr std::size_t kSample = 2048;
  const std::size_t count = ranked.size();
  if (count <= kWarmUp + kSample) return 0;
  const auto points = std::make_unique<Writing>(ranked.header().frame.extent);
  const auto code = [&](std::size_t first, std::size_t last) {
    entropy::SymbolWriter coder;
    for (std::size_t i = first; i < last; ++i) {
      GridPoint p = ranked[i];
      points->code(coder, p);
    }
    return 8.0 * static_cast<double>(coder.finish().size());
  };
  const std::size_t first = (count - kWarmUp - kSample) / 2;
  code(first, first + kWarmUp);
  return code(first + kWarmUp, first + kWarmUp + kSample) / static_cast<double>(kSample);
}

}  // namespace bspc::geometry::fast
