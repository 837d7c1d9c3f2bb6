#include "arrays/low_halves.h"

#include "grid/float_grid.h"

namespace bspc {

std::vector<GridPoint> lowHalvesOf(const PointSetView& points) {
  const std::vector<std::uint64_t> all;
  const lattice::ViewCoordinates coordinates(points, all);
  std::vector<GridPoint> halves(static_cast<std::size_t>(points.size()));
  lattice::lowHalves(coordinates, 0, halves.size(), halves.data());
  return halves;
}

ArrayView lowHalvesView(const std::vector<GridPoint>& halves) {
  ArrayView view;
  view.type = ScalarType::UInt32;
  view.components = 3;
  view.tuples = halves.size();
  view.data = halves.data();
  return view;
}

}  // namespace bspc
