#include "arrays/tile_array_encoder.h"

#include <algorithm>
#include <utility>

#include "arrays/array_tuples.h"
#include "arrays/array_wishes.h"
#include "attributes/array_coder.h"
#include "attributes/order_coder.h"
#include "attributes/tile_points.h"
#include "container/checksum.h"

namespace bspc {

namespace {

bool isIdentity(const std::vector<std::uint32_t>& order) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

template <class T>
std::vector<T> permuted(Span<const T> values, const std::vector<std::uint32_t>& order) {
  std::vector<T> result;
  result.reserve(order.size());
  for (const std::uint32_t i : order) result.push_back(values[i]);
  return result;
}

/// The points of a tile as its arrays are coded: layer after layer.
class LayeredTile {
 public:
  explicit LayeredTile(const TileWithArrays& tile)
      : points_(tile.points), sources_(&tile.sources), order_(tile.geometry.order) {
    const std::vector<std::uint32_t>& layers = tile.geometry.layerOrder;
    if (tile.geometry.nestsPoints && !layers.empty()) {
      ownPoints_ = permuted(points_, layers);
      ownSources_ = permuted(Span<const std::uint64_t>(tile.sources), layers);
      ownOrder_ = permuted(order_, layers);
      points_ = ownPoints_;
      sources_ = &ownSources_;
      order_ = ownOrder_;
    }
    if (tile.geometry.nestsPoints) {
      for (const geometry::LayerSummary& layer : tile.geometry.coarse) {
        ends_.push_back(static_cast<std::size_t>(layer.representatives));
      }
    }
    ends_.push_back(points_.size());
  }
  LayeredTile(const LayeredTile&) = delete;
  LayeredTile& operator=(const LayeredTile&) = delete;

  std::size_t layers() const { return ends_.size(); }
  std::size_t begin(std::size_t layer) const { return layer == 0 ? 0 : ends_[layer - 1]; }
  std::size_t end(std::size_t layer) const { return ends_[layer]; }
  const std::vector<std::uint64_t>& sources() const { return *sources_; }

  /// For the arrays of a layer; the last one knows the order of the input if it is `known`.
  attributes::TilePoints points(std::size_t layer, bool known) const {
    attributes::TilePoints points(points_.subspan(0, end(layer)), begin(layer));
    if (known && layer + 1 == layers()) {
      points.setInputOrder(order_.subspan(begin(layer), end(layer) - begin(layer)));
    }
    return points;
  }

 private:
  Span<const GridPoint> points_;
  const std::vector<std::uint64_t>* sources_;
  Span<const std::uint32_t> order_;
  std::vector<GridPoint> ownPoints_;
  std::vector<std::uint64_t> ownSources_;
  std::vector<std::uint32_t> ownOrder_;
  std::vector<std::size_t> ends_;
};

/// An array on its way through the layers.
struct ArrayInWork {
  attributes::ArrayShape shape;
  attributes::ArrayWishes wishes;
  attributes::ArrayValues all;    ///< as given
  attributes::ArrayValues coded;  ///< up to the layer, as restored
};

}  // namespace

CodedTileArrays TileArrayEncoder::encode(const TileWithArrays& tile) const {
  CodedTileArrays result;
  result.layered = tile.geometry.nestsPoints;
  if (isIdentity(tile.geometry.order)) {
    result.order = container::TileOrder::Decoded;
  } else if (keepsOrder_ || storesOrder_) {
    result.order = container::TileOrder::Stored;
  }
  const LayeredTile layered(tile);
  std::vector<ArrayInWork> work(source_.size());
  for (std::size_t a = 0; a < work.size(); ++a) {
    work[a].shape = source_.shape(a);
    work[a].wishes = wishesFor(source_.description(a), effort_);
    work[a].all = source_.gather(a, layered.sources());
  }
  result.arrays.resize(work.size());
  result.payloads.resize(work.size());
  result.greatestErrors.resize(work.size());
  const bool known = result.order != container::TileOrder::Unknown;
  for (std::size_t layer = 0; layer < layered.layers(); ++layer) {
    attributes::TilePoints points = layered.points(layer, known);
    for (std::size_t a = 0; a < work.size(); ++a) {
      ArrayInWork& array = work[a];
      if (layered.layers() == 1) {
        array.coded = std::move(array.all);
      } else {
        ArrayTuples(array.shape)
            .append(array.coded, array.all, layered.begin(layer), points.added());
      }
      attributes::EncodedArray coded =
          attributes::encodeArray(array.shape, array.coded, points, array.wishes);
      result.arrays[a].needsOrder = points.hasInputOrder() && coded.usesInputOrder;
      result.payloads[a].push_back(std::move(coded.payload));
      result.greatestErrors[a] = std::max(result.greatestErrors[a], coded.greatestError);
    }
  }
  const bool needed = keepsOrder_ || std::any_of(result.arrays.begin(), result.arrays.end(),
                                                 [](const auto& a) { return a.needsOrder; });
  if (result.order == container::TileOrder::Stored) {
    if (needed) {
      result.orderPayload = attributes::encodeOrder(tile.points, tile.geometry.order);
    } else {
      result.order = container::TileOrder::Unknown;
    }
  }
  for (std::size_t a = 0; a < work.size(); ++a) {
    result.arrays[a].contentChecksum =
        container::valuesChecksum(work[a].shape, work[a].coded, tile.points.size());
  }
  return result;
}

}  // namespace bspc
