#include "grid/known_lattice.h"

#include <cmath>

#include "grid/axis_map.h"
#include "grid/lattice.h"

namespace bspc::lattice {

namespace {

/// The same lattice without the multiples that no coordinate uses, if rounding lets them go.
Grid thinnedOut(const Grid& grid, std::size_t axis, std::uint64_t divisor,
                const Coordinates& coordinates) {
  // Rational steps are those that the search for lattices finds by itself.
  if (divisor < 2 || grid.form != Grid::Form::Affine) return grid;
  Grid coarser = grid;
  coarser.axes[axis].step *= static_cast<double>(divisor);
  const bool good =
      std::isfinite(coarser.axes[axis].step) && liesOn(coordinates, axis, AxisMap(coarser, axis));
  return good ? coarser : grid;
}

}  // namespace

std::optional<Grid> confirmedLattice(const Grid& known, const Coordinates& coordinates,
                                     const Ranges& ranges) {
  Grid grid = known;
  grid.scalarType = coordinates.type();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.axes[axis].base = 0;
    const AxisMap map(grid, axis);
    std::uint64_t divisor = 0;
    if (!liesOn(coordinates, axis, map, &divisor)) return std::nullopt;
    grid = thinnedOut(grid, axis, divisor, coordinates);
    if (!fitsIndices(AxisMap(grid, axis), ranges[axis])) return std::nullopt;
  }
  return grid;
}

bool isCoarser(const Grid& one, const Grid& other, const Ranges& ranges) {
  double bits = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (ranges[axis].constant()) continue;
    bits += std::log2(AxisMap(one, axis).step() / AxisMap(other, axis).step());
  }
  // Steps that differ by rounding alone are the same.
  return bits > 1e-6;
}

}  // namespace bspc::lattice
