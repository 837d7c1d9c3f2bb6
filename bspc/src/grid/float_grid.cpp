#include "grid/float_grid.h"

#include <algorithm>
#include <cmath>

namespace bspc::lattice {

Grid floatGrid(ScalarType type) {
  Grid grid;
  grid.form = Grid::Form::FloatBits;
  grid.scalarType = type;
  return grid;
}

OrderRange finiteMultiples(ScalarType type) {
  return type == ScalarType::Float32 ? finiteFloats() : finiteDoubles();
}

std::uint32_t multipleOf(ScalarType type, double value) {
  if (type == ScalarType::Float32) return orderOf(static_cast<float>(value));
  return static_cast<std::uint32_t>(orderOf(value) >> 32);
}

double coordinateOf(ScalarType type, std::int64_t multiple) {
  const OrderRange finite = finiteMultiples(type);
  const auto k = static_cast<std::uint32_t>(
      std::clamp(multiple, std::int64_t{finite.first}, std::int64_t{finite.last}));
  return type == ScalarType::Float32 ? double{floatOfOrder(k)} : doubleOfHalves(k, 0);
}

std::uint32_t finiteMultiple(const Grid& grid, std::size_t axis, std::uint32_t i) {
  const OrderRange finite = finiteMultiples(grid.scalarType);
  return static_cast<std::uint32_t>(std::clamp(grid.axes[axis].base + std::int64_t{i},
                                               std::int64_t{finite.first},
                                               std::int64_t{finite.last}));
}

void placeFloatBases(Grid& grid, const Ranges& ranges) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Ranges do not tell the zeros apart.
    const double lowest = ranges[axis].min == 0 ? -0.0 : ranges[axis].min;
    grid.axes[axis].base = multipleOf(grid.scalarType, lowest);
  }
}

std::uint32_t topFloatIndex(const Grid& grid, std::size_t axis, const AxisRange& range) {
  return multipleOf(grid.scalarType, range.max) - static_cast<std::uint32_t>(grid.axes[axis].base);
}

void quantiseFloats(const Coordinates& coordinates, const Grid& grid, const GridPointSink& sink,
                    const ShareReport& report) {
  constexpr std::uint64_t kReportEvery = 128 * Coordinates::kChunk;
  std::vector<GridPoint> points(Coordinates::kChunk);
  Coordinates::Chunk chunk{};
  const auto total = static_cast<double>(coordinates.size());
  for (std::uint64_t first = 0; first < coordinates.size(); first += Coordinates::kChunk) {
    if (first % kReportEvery == 0) report(static_cast<double>(first) / total);
    const std::size_t count = coordinates.chunkSize(first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates.gather(axis, first, count, chunk.data());
      const auto base = static_cast<std::uint32_t>(grid.axes[axis].base);
      for (std::size_t i = 0; i < count; ++i) {
        points[i][axis] = multipleOf(grid.scalarType, chunk[i]) - base;
      }
    }
    sink(first, Span<const GridPoint>(points.data(), count));
  }
}

void lowHalves(const Coordinates& coordinates, std::uint64_t first, std::size_t count,
               GridPoint* out) {
  Coordinates::Chunk chunk{};
  for (std::size_t done = 0; done < count;) {
    const std::size_t piece = std::min(Coordinates::kChunk, count - done);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates.gather(axis, first + done, piece, chunk.data());
      for (std::size_t i = 0; i < piece; ++i) {
        out[done + i][axis] = static_cast<std::uint32_t>(orderOf(chunk[i]));
      }
    }
    done += piece;
  }
}

bool hasNegativeZero(const Coordinates& coordinates) {
  const auto isOther = [](double value) { return value != 0 || !std::signbit(value); };
  return !(coordinates.all(0, isOther) && coordinates.all(1, isOther) &&
           coordinates.all(2, isOther));
}

}  // namespace bspc::lattice
