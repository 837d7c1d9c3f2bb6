#include "geometry/fast/tile_sequence.h"

#include <algorithm>

#include "entropy/symbol_coder.h"
#include "geometry/fast/hilbert.h"
#include "geometry/fast/slab_sorter.h"

namespace bspc::geometry::fast {

std::vector<std::uint32_t> LayerStrides::layerAfterLayer(unsigned layer) const {
  std::vector<std::uint32_t> order;
  order.reserve(static_cast<std::size_t>(upTo(layer)));
  const unsigned bits = strideBits(layer);
  for (unsigned l = 0; l <= layer; ++l) {
    for (std::uint64_t i = 0; i < upTo(l); ++i) {
      const std::uint64_t place = i << strideBits(l);
      if (isNew(place, l)) order.push_back(static_cast<std::uint32_t>(place >> bits));
    }
  }
  return order;
}

std::vector<std::uint32_t> hilbertSequence(const std::vector<GridPoint>& points,
                                           const GridPoint& extent) {
  const unsigned bits = entropy::bitLength(std::max({extent[0], extent[1], extent[2]}));
  std::vector<std::uint64_t> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) places[i] = hilbertPlaceInSpace(points[i], bits);
  CodeSorter sorter;
  std::vector<std::uint32_t> sequence = sorter.sort(places, 3 * std::min(bits, 16U));
  for (std::size_t first = 0; first < sequence.size();) {
    std::size_t last = first + 1;
    while (last < sequence.size() && places[sequence[last]] == places[sequence[first]]) ++last;
    if (last - first > 1) {
      const auto begin = sequence.begin() + static_cast<std::ptrdiff_t>(first);
      std::sort(begin, begin + static_cast<std::ptrdiff_t>(last - first),
                [&points](std::uint32_t a, std::uint32_t b) {
                  return points[a] != points[b] ? points[a] < points[b] : a < b;
                });
    }
    first = last;
  }
  return sequence;
}

}  // namespace bspc::geometry::fast
