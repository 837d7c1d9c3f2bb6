#include "point_selection.h"

#include <iterator>
#include <string>
#include <utility>

#include "arrays/array_tuples.h"

namespace bspc {

namespace {

ArrayTuples tuplesOf(const ArrayDescription& array) {
  return ArrayTuples({array.type, array.components, array.semantic});
}

template <class T>
void keepIn(std::vector<T>& values, const std::vector<std::size_t>& kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

template <class T>
void reorderIn(std::vector<T>& values, Span<const std::uint32_t> places) {
  if (values.empty()) return;
  std::vector<T> moved(values.size());
  for (std::size_t j = 0; j < places.size(); ++j) moved[places[j]] = values[j];
  values = std::move(moved);
}

template <class T>
void appendTo(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

void keepPoints(DecodedPoints& points, const std::vector<std::size_t>& kept) {
  if (kept.size() == points.points.size()) return;
  keepIn(points.points, kept);
  keepIn(points.lowHalves, kept);
  keepIn(points.counts, kept);
  keepIn(points.cellIds, kept);
  for (ArrayValues& array : points.arrays) {
    tuplesOf(array).keep(array.values, array.strings, kept);
  }
}

void reorderPoints(DecodedPoints& points, Span<const std::uint32_t> places) {
  reorderIn(points.points, places);
  reorderIn(points.lowHalves, places);
  reorderIn(points.counts, places);
  reorderIn(points.cellIds, places);
  for (ArrayValues& array : points.arrays) {
    tuplesOf(array).scatter(array.values, array.strings, places);
  }
}

void appendPoints(DecodedPoints& to, DecodedPoints&& from) {
  appendTo(to.points, std::move(from.points));
  appendTo(to.lowHalves, std::move(from.lowHalves));
  appendTo(to.counts, std::move(from.counts));
  appendTo(to.cellIds, std::move(from.cellIds));
  for (std::size_t a = 0; a < to.arrays.size(); ++a) {
    appendTo(to.arrays[a].values, std::move(from.arrays[a].values));
    appendTo(to.arrays[a].strings, std::move(from.arrays[a].strings));
  }
}

std::uint64_t memoryOf(const DecodedPoints& points) {
  std::uint64_t bytes =
      (points.points.capacity() + points.lowHalves.capacity()) * sizeof(GridPoint) +
      (points.counts.capacity() + points.cellIds.capacity()) * 8;
  for (const ArrayValues& array : points.arrays) {
    bytes += array.values.capacity();
    for (const std::string& text : array.strings) bytes += sizeof(std::string) + text.size();
  }
  return bytes;
}

}  // namespace bspc
