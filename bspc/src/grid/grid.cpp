#include "bspc/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>

#include "bspc/error.h"
#include "grid/axis_kernel.h"
#include "grid/axis_map.h"
#include "grid/float_grid.h"

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
  if (form == Form::FloatBits) return lattice::coordinateOf(scalarType, k);
  return (static_cast<double>(k) * static_cast<double>(a.numerator)) /
         static_cast<double>(a.denominator);
}

double Grid::step(int axis) const {
  const Axis& a = axes[static_cast<std::size_t>(axis)];
  if (form == Form::Affine) return a.step;
  if (form == Form::FloatBits) return 0;
  return static_cast<double>(a.numerator) / static_cast<double>(a.denominator);
}

bool Grid::sameLattice(const Grid& other) const {
  if (form != other.form) return false;
  if (form == Form::FloatBits) return scalarType == other.scalarType;
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
  if (form > Form::FloatBits) {
    throw Error(ErrorCode::InvalidArgument,
                "the grid's form is neither rational nor affine nor that of float bits; choose one "
                "of the three");
  }
  if (form == Form::FloatBits) {
    if (!isFloatingPoint(scalarType)) {
      throw Error(ErrorCode::InvalidArgument, std::string("a grid of float bits cannot restore ") +
                                                  scalarName(scalarType) +
                                                  "; give it float32 or float64");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axes[axis].base < 0 || axes[axis].base > std::numeric_limits<std::uint32_t>::max()) {
        refuse(axis, "a base outside 0 … 2^32 - 1");
      }
    }
    return;
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

GridRequest GridRequest::exactFloats() {
  GridRequest request;
  request.kind = Kind::ExactFloats;
  return request;
}

double restoredCoordinate(const Grid& grid, int axis, std::uint32_t i) {
  if (lattice::isFloatGrid(grid)) return grid.coordinate(axis, i);  // −0 stays −0
  return lattice::roundToScalar(grid.scalarType, grid.coordinate(axis, i));
}

namespace {

constexpr std::size_t kTogether = 16;  ///< points that fill many vectors: no loop is unrolled
using LaneIndices = std::array<std::uint32_t, 3 * kTogether>;

/// Bits that the indices have along the axes, by turns: no index has another one.
LaneIndices bitsOf(Span<const GridPoint> points) {
  LaneIndices all{};
  const std::size_t inBlocks = points.size() / kTogether * kTogether;
  for (std::size_t first = 0; first < inBlocks; first += kTogether) {
    LaneIndices block;
    std::memcpy(block.data(), &points[first], sizeof block);
    for (std::size_t i = 0; i < block.size(); ++i) all[i] |= block[i];
  }
  for (std::size_t j = inBlocks; j < points.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) all[k] |= points[j][k];
  }
  return all;
}

/// The bases in all lanes, if all multiples of the points are within the limits.
std::optional<LaneIndices> basesWithin(const Grid& grid, Span<const GridPoint> points,
                                       std::int64_t low, std::int64_t high) {
  const LaneIndices all = bitsOf(points);
  LaneIndices bases{};
  for (std::size_t i = 0; i < bases.size(); ++i) {
    const std::int64_t base = grid.axes[i % 3].base;
    if (base < low || base + std::int64_t{all[i]} > high) return std::nullopt;
    bases[i] = static_cast<std::uint32_t>(base);
  }
  return bases;
}

/// Calls restored(multiple, lane) for all coordinates, whose multiples must have 32 bits.
template <class T, class Restored>
void restoreLanes(const LaneIndices& bases, Span<const GridPoint> points, T* xyz,
                  Restored restored) {
  const std::size_t inBlocks = points.size() / kTogether * kTogether;
  for (std::size_t first = 0; first < inBlocks; first += kTogether) {
    LaneIndices block;
    std::memcpy(block.data(), &points[first], sizeof block);
    T* to = xyz + 3 * first;
    for (std::size_t i = 0; i < block.size(); ++i) {
      to[i] = restored(static_cast<std::int32_t>(bases[i] + block[i]), i);
    }
  }
  for (std::size_t j = inBlocks; j < points.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[3 * j + k] = restored(static_cast<std::int32_t>(bases[k] + points[j][k]), k);
    }
  }
}

/// Restores a block of points whose coordinates are whole numbers in 32 bits, and are their own
/// multiples; false if the block is not such.
template <class T>
bool restoreWhole(const Grid& grid, Span<const GridPoint> points, T* xyz) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  constexpr std::int64_t kExactFloat = std::int64_t{1} << 24;
  std::int64_t low = -kMost;
  std::int64_t high = kMost;
  if (std::is_integral_v<T>) {
    low = std::max(low, static_cast<std::int64_t>(std::numeric_limits<T>::min()));
    if (sizeof(T) < 4) high = static_cast<std::int64_t>(std::numeric_limits<T>::max());
  }
  if (grid.scalarType == ScalarType::Float32) {
    low = std::max(low, -kExactFloat);
    high = std::min(high, kExactFloat);
  } else if (!isFloatingPoint(grid.scalarType)) {
    const lattice::IntegerLimits limits = lattice::integerLimits(grid.scalarType);
    low = static_cast<std::int64_t>(std::max(static_cast<double>(low), limits.min));
    high = static_cast<std::int64_t>(std::min(static_cast<double>(high), limits.max));
  }
  const auto bases = basesWithin(grid, points, low, high);
  if (!bases) return false;
  restoreLanes(*bases, points, xyz, [](std::int32_t multiple, std::size_t /*lane*/) {
    return static_cast<T>(multiple);
  });
  return true;
}

/// The same of floating-point numbers: processors convert several multiples of 32 bits at once.
template <class T>
bool restoreNarrow(const Grid& grid, Span<const GridPoint> points, T* xyz) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const auto bases = basesWithin(grid, points, -kMost, kMost);
  if (!bases) return false;
  const std::array<lattice::AxisMap, 3> maps{lattice::AxisMap(grid, 0), lattice::AxisMap(grid, 1),
                                             lattice::AxisMap(grid, 2)};
  return lattice::withKernel<3 * kTogether>(maps, [&](const auto& kernel) {
    restoreLanes(*bases, points, xyz, [kernel](std::int32_t multiple, std::size_t lane) {
      const auto value = kernel.restored(multiple, lane);
      if constexpr (std::is_same_v<decltype(value), const T>) {
        return value;
      } else {
        return toScalar<T>(double{value});
      }
    });
    return true;
  });
}

bool hasWholeSteps(const Grid& grid) {
  return lattice::AxisMap(grid, 0).isWhole() && lattice::AxisMap(grid, 1).isWhole() &&
         lattice::AxisMap(grid, 2).isWhole();
}

template <class T>
void restoreAxis(const Grid& grid, std::size_t axis, Span<const GridPoint> points, T* xyz) {
  const lattice::AxisMap map(grid, axis);
  const std::int64_t base = grid.axes[axis].base;
  for (std::size_t j = 0; j < points.size(); ++j) {
    // Through the grid's own type first: every reader then returns the same coordinate, whatever
    // type it asks for.
    const auto multiple = static_cast<double>(base + std::int64_t{points[j][axis]});
    xyz[3 * j + axis] = toScalar<T>(map.restored(multiple));
  }
}

/// A coordinate of a float grid in the caller's type; floats keep every bit, integers are rounded.
template <class T>
T fromFloatGrid(double value) {
  if constexpr (std::is_same_v<T, float>) {
    return lattice::nearestFloat(value);
  } else {
    return toScalar<T>(value);
  }
}

template <class T>
void restoreFloats(const Grid& grid, Span<const GridPoint> points, Span<const GridPoint> lowHalves,
                   T* xyz) {
  const bool single = grid.scalarType == ScalarType::Float32;
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t multiple = lattice::finiteMultiple(grid, k, points[j][k]);
      const std::uint32_t low = lowHalves.empty() ? 0 : lowHalves[j][k];
      xyz[3 * j + k] = fromFloatGrid<T>(single ? double{lattice::floatOfOrder(multiple)}
                                               : lattice::doubleOfHalves(multiple, low));
    }
  }
}

}  // namespace

template <class T>
void restorePositions(const Grid& grid, Span<const GridPoint> points,
                      Span<const GridPoint> lowHalves, T* xyz) {
  if (lattice::isFloatGrid(grid)) return restoreFloats(grid, points, lowHalves, xyz);
  restorePositions(grid, points, xyz);
}

template <class T>
void restorePositions(const Grid& grid, Span<const GridPoint> points, T* xyz) {
  if (lattice::isFloatGrid(grid)) return restoreFloats(grid, points, {}, xyz);
  // A block stays in the cache while its three axes are restored.
  constexpr std::size_t kBlock = 1024;
  const bool whole = hasWholeSteps(grid);
  for (std::size_t first = 0; first < points.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - first);
    if (whole && restoreWhole(grid, points.subspan(first, count), xyz + 3 * first)) continue;
    if (restoreNarrow(grid, points.subspan(first, count), xyz + 3 * first)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      restoreAxis(grid, axis, points.subspan(first, count), xyz + 3 * first);
    }
  }
}

template void restorePositions(const Grid&, Span<const GridPoint>, float*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>, float*);
template void restorePositions(const Grid&, Span<const GridPoint>, double*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>, double*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::int8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::int16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::int32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::int64_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::int64_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::uint8_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::uint16_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::uint32_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, std::uint64_t*);
template void restorePositions(const Grid&, Span<const GridPoint>, Span<const GridPoint>,
                               std::uint64_t*);

}  // namespace bspc
