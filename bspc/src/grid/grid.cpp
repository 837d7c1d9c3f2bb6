#include "bspc/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>

#include "bspc/error.h"
#include "grid/axis_map.h"

namespace bspc {

namespace lattice {

namespace {

template <class T>
constexpr IntegerLimits limitsOf() {
  return {static_cast<double>(std::numeric_limits<T>::min()),
          static_cast<double>(std::numeric_limits<T>::max())};
}

}  // namespace

IntegerLimits integerLimits(ScalarType type) {
  switch (type) {
    case ScalarType::Int8:
      return limitsOf<std::int8_t>();
    case ScalarType::UInt8:
      return limitsOf<std::uint8_t>();
    case ScalarType::Int16:
      return limitsOf<std::int16_t>();
    case ScalarType::UInt16:
      return limitsOf<std::uint16_t>();
    case ScalarType::Int32:
      return limitsOf<std::int32_t>();
    case ScalarType::UInt32:
      return limitsOf<std::uint32_t>();
    case ScalarType::UInt64:
      return limitsOf<std::uint64_t>();
    default:
      return limitsOf<std::int64_t>();
  }
}

}  // namespace lattice

namespace {

[[noreturn]] void refuse(std::size_t axis, const std::string& reason) {
  throw Error(ErrorCode::InvalidArgument, std::string("the grid's ") + "xyz"[axis] + " axis has " +
                                              reason + "; choose another step or origin");
}

std::int64_t oddPart(std::int64_t value) {
  while (value % 2 == 0) value /= 2;
  return value;
}

void validateRatio(std::size_t axis, const Grid::Axis& a) {
  constexpr std::int64_t kMax = std::int64_t{1} << 62;
  constexpr std::int64_t kMaxOdd = std::int64_t{1} << 53;
  for (const std::int64_t part : {a.numerator, a.denominator}) {
    if (part < 1 || part > kMax) refuse(axis, "a numerator or denominator outside 1 … 2^62");
    if (oddPart(part) >= kMaxOdd) {
      refuse(axis, "a numerator or denominator whose odd part reaches 2^53");
    }
  }
  if (std::gcd(a.numerator, a.denominator) != 1) {
    refuse(axis, "a numerator and a denominator with a common factor");
  }
}

/// The nearest T, out-of-range values clamped; `value` is no NaN.
template <class T>
T toScalar(double value) {
  if constexpr (std::is_same_v<T, float>) {
    return lattice::nearestFloat(value) + 0.0F;
  } else if constexpr (std::is_same_v<T, double>) {
    return value;
  } else {
    // The greatest 64-bit integers are no doubles: compare before converting.
    if (value <= static_cast<double>(std::numeric_limits<T>::min())) {
      return std::numeric_limits<T>::min();
    }
    if (value >= static_cast<double>(std::numeric_limits<T>::max())) {
      return std::numeric_limits<T>::max();
    }
    return static_cast<T>(lattice::roundHalfAway(value));
  }
}

}  // namespace

double Grid::coordinate(int axis, std::uint32_t i) const {
  return coordinateOfMultiple(axis, axes[static_cast<std::size_t>(axis)].base + std::int64_t{i});
}

double Grid::coordinateOfMultiple(int axis, std::int64_t k) const {
  const Axis& a = axes[static_cast<std::size_t>(axis)];
  if (form == Form::Affine) return a.origin + static_cast<double>(k) * a.step;
  return (static_cast<double>(k) * static_cast<double>(a.numerator)) /
         static_cast<double>(a.denominator);
}

double Grid::step(int axis) const {
  const Axis& a = axes[static_cast<std::size_t>(axis)];
  if (form == Form::Affine) return a.step;
  return static_cast<double>(a.numerator) / static_cast<double>(a.denominator);
}

bool Grid::sameLattice(const Grid& other) const {
  if (form != other.form) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Axis& a = axes[axis];
    const Axis& b = other.axes[axis];
    const bool same =
        form == Form::Rational
            ? a.numerator == b.numerator && a.denominator == b.denominator
            : !(a.origin < b.origin || a.origin > b.origin || a.step < b.step || a.step > b.step);
    if (!same) return false;
  }
  return true;
}

void Grid::validate() const {
  constexpr std::int64_t kMaxBase = std::int64_t{1} << 62;
  if (static_cast<std::uint8_t>(scalarType) >= kPositionTypeCount) {
    throw Error(ErrorCode::InvalidArgument, std::string("a grid cannot restore ") +
                                                scalarName(scalarType) +
                                                "; give it one of the ten numeric types");
  }
  if (form != Form::Rational && form != Form::Affine) {
    throw Error(ErrorCode::InvalidArgument,
                "the grid's form is neither rational nor affine; choose one of the two");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Axis& a = axes[axis];
    if (a.base < -kMaxBase || a.base > kMaxBase) refuse(axis, "a base outside ±2^62");
    if (form == Form::Rational) {
      validateRatio(axis, a);
    } else if (!std::isfinite(a.origin)) {
      refuse(axis, "an origin that is not finite");
    } else if (!std::isfinite(a.step) || a.step <= 0) {
      refuse(axis, "a step that is not finite and positive");
    }
  }
}

GridRequest GridRequest::withBits(unsigned bits) {
  if (bits < 1 || bits > 32) {
    throw Error(ErrorCode::InvalidArgument, "grids have 1 to 32 bits an axis, not " +
                                                std::to_string(bits) +
                                                "; choose a number in that range");
  }
  GridRequest request;
  request.kind = Kind::Bits;
  request.bits = bits;
  return request;
}

GridRequest GridRequest::withPrecision(double precision) {
  if (!std::isfinite(precision) || precision <= 0) {
    throw Error(ErrorCode::InvalidArgument,
                "the precision is not a finite number above zero; give the wished step in the "
                "units of the data");
  }
  GridRequest request;
  request.kind = Kind::Precision;
  request.precision = precision;
  return request;
}

GridRequest GridRequest::onGrid(const Grid& grid) {
  grid.validate();
  GridRequest request;
  request.kind = Kind::Reuse;
  request.reuse = grid;
  return request;
}

double restoredCoordinate(const Grid& grid, int axis, std::uint32_t i) {
  return lattice::roundToScalar(grid.scalarType, grid.coordinate(axis, i));
}

namespace {

/// Restores integers that are their own multiples: the bounds of both types, in integers.
template <class T>
void restoreIntegers(const Grid& grid, std::size_t axis, Span<const GridPoint> points, T* xyz) {
  const std::int64_t base = grid.axes[axis].base;
  const lattice::IntegerLimits limits = lattice::integerLimits(grid.scalarType);
  const auto low =
      std::max(static_cast<std::int64_t>(limits.min), std::int64_t{std::numeric_limits<T>::min()});
  const auto high =
      std::min(static_cast<std::int64_t>(limits.max), std::int64_t{std::numeric_limits<T>::max()});
  for (std::size_t j = 0; j < points.size(); ++j) {
    const std::int64_t value = base + std::int64_t{points[j][axis]};
    xyz[3 * j + axis] = static_cast<T>(std::max(low, std::min(high, value)));
  }
}

/// Whether restoreIntegers() gives what the formulas of the format give: 64-bit types have limits
/// that are no doubles, and sums must stay exact.
template <class T>
bool suitsIntegers(const Grid& grid, const lattice::AxisMap& map, std::size_t axis) {
  constexpr std::int64_t kExact = std::int64_t{1} << 52;
  if (!std::is_integral_v<T> || sizeof(T) > 4 || scalarSize(grid.scalarType) > 4) return false;
  const std::int64_t base = grid.axes[axis].base;
  return map.isIdentity() && -kExact <= base && base <= kExact;
}

template <class T>
void restoreAxis(const Grid& grid, std::size_t axis, Span<const GridPoint> points, T* xyz) {
  const lattice::AxisMap map(grid, axis);
  if constexpr (std::is_integral_v<T> && sizeof(T) <= 4) {
    if (suitsIntegers<T>(grid, map, axis)) return restoreIntegers(grid, axis, points, xyz);
  }
  const std::int64_t base = grid.axes[axis].base;
  for (std::size_t j = 0; j < points.size(); ++j) {
    // Through the grid's own type first: every reader then returns the same coordinate, whatever
    // type it asks for.
    const auto multiple = static_cast<double>(base + std::int64_t{points[j][axis]});
    xyz[3 * j + axis] = toScalar<T>(map.restored(multiple));
  }
}

}  // namespace

template <class T>
void restorePositions(const Grid& grid, Span<const GridPoint> points, T* xyz) {
  // A block stays in the cache while its three axes are restored.
  constexpr std::size_t kBlock = 1024;
  for (std::size_t first = 0; first < points.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      restoreAxis(grid, axis, points.subspan(first, count), xyz + 3 * first);
    }
  }
}

template void restorePositions(const Grid&, Span<const GridPoint>, float*);
template void restorePositions(const Grid&, Span<const GridPoint>, double*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int64_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint64_t*);

}  // namespace bspc
