#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/point_set.h"
#include "bspc/progress.h"
#include "bspc/scalar_type.h"

namespace bspc {

/// Integer coordinates of a point: the steps from the grid's base along x, y, z.
using GridPoint = std::array<std::uint32_t, 3>;

/// The integer lattice that a file's coordinates live on (docs/format.md, "Grid").
///
/// An axis turns the index i (0 ≤ i < 2^32) into a coordinate in exactly one of three ways, the
/// first two computed in IEEE double precision in the order written:
///   Rational:  (double(base + i) * double(numerator)) / double(denominator)
///   Affine:    origin + double(base + i) * step
///   FloatBits: the floating-point number whose place among all of its type is base + i, for
///              float64 that of its upper half; low halves then stand beside the grid points
///              (DecodedPoints::lowHalves). Keeps every bit, the sign of zero among them.
struct Grid {
  enum class Form : std::uint8_t { Rational = 0, Affine = 1, FloatBits = 2 };

  struct Axis {
    std::int64_t base = 0;         ///< |base| ≤ 2^62
    std::int64_t numerator = 1;    ///< Rational: 1 … 2^62, in lowest terms with the denominator;
                                   ///< its odd part below 2^53
    std::int64_t denominator = 1;  ///< Rational: likewise
    double origin = 0;             ///< Affine: finite
    double step = 1;               ///< Affine: finite, > 0
  };

  Form form = Form::Rational;
  /// The type that went in, and that readers return.
  ScalarType scalarType = ScalarType::Float32;
  std::array<Axis, 3> axes{};

  /// The coordinate of index `i` along `axis`, in double precision.
  double coordinate(int axis, std::uint32_t i) const;
  /// The same for any multiple of the step: `k` counts from zero, not from the base.
  double coordinateOfMultiple(int axis, std::int64_t k) const;
  /// The distance of two neighbouring indices, in the units of the data; 0 for FloatBits, where it
  /// differs from place to place.
  double step(int axis) const;
  /// Whether both put points at the same places, whatever their bases and scalar types.
  bool sameLattice(const Grid& other) const;
  /// Throws Error(InvalidArgument) with the reason if a field is out of the ranges above.
  void validate() const;
};

/// How positions become grid points.
struct GridRequest {
  enum class Kind {
    /// Finds the lattice that the coordinates lie on and is exact; otherwise a step equal to the
    /// float spacing of the largest coordinate (float32) or 31 bits of the extent (float64).
    Automatic,
    /// One step for all axes; the largest extent spans 2^bits − 1 steps.
    Bits,
    /// One step for all axes: `precision`, in units of the data; errors are at most half of it.
    Precision,
    /// The lattice of `reuse`, its base moved where points lie below it.
    Reuse,
    /// Bit for bit: a lattice if the coordinates lie on one and none is −0, else FloatBits.
    ExactFloats,
  };
  Kind kind = Kind::Automatic;
  unsigned bits = 0;     ///< 1 … 32
  double precision = 0;  ///< finite, > 0
  Grid reuse;
  /// Reuse only: the bases stay where they are, and points that lie below are Error(OutOfGrid).
  bool keepBase = false;
  /// Automatic only: a lattice that the coordinates are said to lie on, such as the scale and
  /// offset of a file that holds integers. Its bases count for nothing. It is taken if it restores
  /// every coordinate exactly and the search finds no coarser lattice that does.
  std::optional<Grid> knownLattice;
  /// Leave out points with a NaN or infinite coordinate instead of refusing them.
  bool dropNonFinite = false;

  static GridRequest automatic() { return {}; }
  static GridRequest withBits(unsigned bits);
  static GridRequest withPrecision(double precision);
  static GridRequest onGrid(const Grid& grid);
  static GridRequest exactFloats();
};

/// A point set on its grid.
struct GridFit {
  Grid grid;
  std::vector<GridPoint> points;  ///< in input order, dropped points left out
  /// Input index of points[j]; empty if none was dropped (then it is j).
  std::vector<std::uint64_t> sourceIndex;
  std::uint64_t dropped = 0;  ///< points left out because a coordinate was not finite
  /// Whether every coordinate comes back as the very number that went in (−0 as +0).
  bool exact = true;
  /// Greatest |restored − given| along each axis, in units of the data, as restored in
  /// grid.scalarType.
  std::array<double, 3> maxError{};
};

/// Puts positions on a grid.
///
/// Throws Error: NonFinite names the first such point (unless dropped); OutOfGrid if an extent
/// needs more than 32 bits at the wished step; InvalidArgument for wishes out of range.
GridFit fitGrid(const PointSetView& points, const GridRequest& request,
                const ProgressCallback& progress = {});

/// The coordinate that a reader returns: grid.coordinate rounded to grid.scalarType, as a double;
/// for FloatBits of float64 the least of those that share the index.
double restoredCoordinate(const Grid& grid, int axis, std::uint32_t i);

/// Writes positions as packed x, y, z triples of T (float, double or an integer type), `points`
/// in, 3 × points.size() numbers out. Integer types are rounded to nearest and clamped to T.
template <class T>
void restorePositions(const Grid& grid, Span<const GridPoint> points, T* xyz);
/// The same with low halves, as many as points or none.
template <class T>
void restorePositions(const Grid& grid, Span<const GridPoint> points,
                      Span<const GridPoint> lowHalves, T* xyz);

}  // namespace bspc
