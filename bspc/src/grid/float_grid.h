#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/grid.h"
#include "grid/coordinates.h"
#include "grid/float_order.h"
#include "grid/grid_fit.h"

namespace bspc::lattice {

/// The grid on which every float of a type has a place of its own, or shares it with those that
/// have the same upper half (docs/format.md, "Grid", form 2). Bases are not placed yet.
Grid floatGrid(ScalarType type);

inline bool isFloatGrid(const Grid& grid) { return grid.form == Grid::Form::FloatBits; }
/// Whether points need low halves beside the grid to be exact.
inline bool hasLowHalves(const Grid& grid) {
  return isFloatGrid(grid) && grid.scalarType == ScalarType::Float64;
}

/// The numbers of finite coordinates, as multiples of a float grid.
OrderRange finiteMultiples(ScalarType type);
/// The multiple of a finite coordinate.
std::uint32_t multipleOf(ScalarType type, double value);
/// The multiple base + i, moved into the finite ones: a file can claim any.
std::uint32_t finiteMultiple(const Grid& grid, std::size_t axis, std::uint32_t i);
/// The coordinate of a multiple with the lowest low half.
double coordinateOf(ScalarType type, std::int64_t multiple);

/// As their namesakes without "Float" in grid_fit.h.
void placeFloatBases(Grid& grid, const Ranges& ranges);
std::uint32_t topFloatIndex(const Grid& grid, std::size_t axis, const AxisRange& range);
void quantiseFloats(const Coordinates& coordinates, const Grid& grid, const GridPointSink& sink,
                    const ShareReport& report);

/// The low halves of float64 coordinates of the points first … first + count − 1.
void lowHalves(const Coordinates& coordinates, std::uint64_t first, std::size_t count,
               GridPoint* out);

/// Whether a coordinate is −0, which other grids turn into +0.
bool hasNegativeZero(const Coordinates& coordinates);

}  // namespace bspc::lattice
