#include "round_trip_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace bspc::fuzz {

namespace {

constexpr std::uint64_t kMostPoints = 400;

template <class T>
void put(Bytes& bytes, double value) {
  T number{};
  if constexpr (std::is_floating_point_v<T>) {
    number = static_cast<T>(value);
  } else {
    // 2^63 and 2^64 are not numbers of the type but their predecessors in double precision are.
    const auto lowest = static_cast<double>(std::numeric_limits<T>::min());
    const auto highest = std::nextafter(std::ldexp(1.0, std::numeric_limits<T>::digits), 0.0);
    number = static_cast<T>(std::min(std::max(value, lowest), highest));
  }
  std::uint8_t raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.insert(bytes.end(), raw, raw + sizeof number);
}

void putNumber(Bytes& bytes, ScalarType type, double value) {
  switch (type) {
    case ScalarType::Float32:
      return put<float>(bytes, value);
    case ScalarType::Float64:
      return put<double>(bytes, value);
    case ScalarType::Int8:
      return put<std::int8_t>(bytes, value);
    case ScalarType::UInt8:
      return put<std::uint8_t>(bytes, value);
    case ScalarType::Int16:
      return put<std::int16_t>(bytes, value);
    case ScalarType::UInt16:
      return put<std::uint16_t>(bytes, value);
    case ScalarType::Int32:
      return put<std::int32_t>(bytes, value);
    case ScalarType::UInt32:
      return put<std::uint32_t>(bytes, value);
    case ScalarType::Int64:
      return put<std::int64_t>(bytes, value);
    default:
      return put<std::uint64_t>(bytes, value);
  }
}

double doubleOf(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

ScalarType positionType(Choices& choices) {
  // Most points of the world are float32.
  return choices.below(3) == 0 ? static_cast<ScalarType>(choices.below(kPositionTypeCount))
                               : static_cast<ScalarType>(choices.below(2));
}

/// One value of an array, of the tuple of number `i`.
void putValue(ArrayValues& array, unsigned way, std::uint64_t i, Choices& choices) {
  if (array.type == ScalarType::String) {
    const std::uint64_t number = way == 0 ? 7 : choices.below(way < 3 ? 4 : 256);
    array.strings.push_back(number % 5 == 0 ? std::string() : "text " + std::to_string(number));
    return;
  }
  if (array.type == ScalarType::Bit) {
    array.values.push_back(static_cast<std::uint8_t>(choices.below(2)));
    return;
  }
  switch (way) {
    case 0:
      return putNumber(array.values, array.type, 7);
    case 1:
      return putNumber(array.values, array.type, static_cast<double>(i));
    case 2:
      return putNumber(array.values, array.type, 0.01 * static_cast<double>(choices.below(100)));
    case 3:
      return putNumber(array.values, array.type, static_cast<double>(choices.bits(16)) - 32768);
    default:
      break;
  }
  const std::uint64_t bits = choices.bits(64);
  for (std::size_t b = 0; b < scalarSize(array.type); ++b) {
    array.values.push_back(static_cast<std::uint8_t>(bits >> (8 * b)));
  }
}

std::vector<ArrayValues> chosenArrays(Choices& choices, std::uint64_t tuples) {
  std::vector<ArrayValues> arrays;
  const std::uint64_t count = choices.below(4);
  for (std::uint64_t a = 0; a < count; ++a) {
    ArrayValues array;
    array.name = "array " + std::to_string(a);
    array.type = choices.yes() ? static_cast<ScalarType>(choices.below(12))
                               : static_cast<ScalarType>(choices.below(2));
    array.semantic = static_cast<Semantic>(choices.below(6));
    array.components = static_cast<std::uint32_t>(
        array.semantic == Semantic::Normals ? 3 : 1 + choices.below(choices.yes() ? 9 : 2));
    if (isFloatingPoint(array.type) && choices.yes()) {
      constexpr std::array<double, 6> kTolerances{1e-300, 1e-6, 0.01, 1, 30, 1e30};
      array.tolerance = kTolerances[static_cast<std::size_t>(choices.below(6))];
    }
    const auto way = static_cast<unsigned>(choices.below(5));
    for (std::uint64_t i = 0; i < tuples; ++i) {
      for (std::uint32_t c = 0; c < array.components; ++c) putValue(array, way, i, choices);
    }
    arrays.push_back(std::move(array));
  }
  return arrays;
}

}  // namespace

RoundTripInput::RoundTripInput(Choices& choices) {
  chooseOptions(choices);
  chooseGrid(choices);
  chooseMetadata(choices);
  // What needs most bytes comes last, so that an input that ends early has a little of everything.
  const bool mesh = choices.below(3) == 0;
  choosePoints(choices);
  if (mesh && size() > 0) chooseCells(choices);
  arrays = chosenArrays(choices, size());
  if (!cells.empty() && choices.yes()) cellArrays = chosenArrays(choices, cells.size());
}

PointSetView RoundTripInput::view() const {
  PointSetView view = part(0, size());
  if (cells.empty()) return view;
  view.setMesh(&cells);
  for (const ArrayValues& array : cellArrays) view.addCellArray(array.view());
  return view;
}

PointSetView RoundTripInput::part(std::uint64_t first, std::uint64_t count) const {
  const std::size_t stride = 3 * scalarSize(type);
  PointSetView view(positions.data() + static_cast<std::size_t>(first) * stride, type, count, 0);
  for (const ArrayValues& array : arrays) {
    ArrayView values = array.view();
    const auto skipped = static_cast<std::size_t>(first) * array.components;
    if (array.type == ScalarType::String) {
      values.data = array.strings.data() + skipped;
    } else {
      values.data = array.values.data() + skipped * arrayValueSize(array.type);
    }
    values.tuples = count;
    view.addArray(std::move(values));
  }
  return view;
}

void RoundTripInput::chooseOptions(Choices& choices) {
  constexpr std::array<Method, 7> kMethods{Method::Kd,      Method::Bsp,  Method::Octree,
                                           Method::GenCode, Method::Fast, Method::Predictive,
                                           Method::Surface};
  options.threads = 1;
  options.wantOrder = true;
  if (choices.yes()) {
    options.method = kMethods[static_cast<std::size_t>(choices.below(kMethods.size()))];
  } else if (choices.below(8) != 0) {
    options.effort = static_cast<unsigned>(1 + choices.below(9));
  } else {
    options.seconds = 0.001 * static_cast<double>(choices.below(100));
  }
  options.layers = choices.yes() ? static_cast<unsigned>(choices.below(5))
                                 : static_cast<unsigned>(choices.below(kMaxLayers + 1));
  if (choices.yes()) options.layers = 1;
  options.layout = choices.yes() ? Layout::Streaming : Layout::Progressive;
  options.keepOrder = choices.below(3) == 0;
  options.originalIds = choices.below(4) == 0;
  if (choices.below(3) == 0) options.tilePoints = 8 + choices.below(100);
  if (choices.below(6) == 0) options.stopPoints = choices.below(10);
  if (choices.below(6) == 0) options.stopLevel = static_cast<unsigned>(choices.below(40));
}

void RoundTripInput::chooseGrid(Choices& choices) {
  switch (choices.below(8)) {
    case 0:
      options.grid = GridRequest::withBits(static_cast<unsigned>(1 + choices.below(32)));
      break;
    case 1:
      options.grid =
          GridRequest::withPrecision(std::ldexp(1.0, 8 - static_cast<int>(choices.below(24))));
      break;
    case 2:
    case 3:
      options.grid = GridRequest::exactFloats();
      break;
    case 4: {
      Grid grid;
      for (Grid::Axis& axis : grid.axes) {
        axis.base = static_cast<std::int64_t>(choices.below(1000)) - 500;
        axis.denominator = std::int64_t{1} << choices.below(8);
      }
      if (choices.yes()) {
        grid.form = Grid::Form::Affine;
        for (Grid::Axis& axis : grid.axes)
          axis.step = 0.01 * static_cast<double>(1 + choices.below(9));
      }
      options.grid = GridRequest::onGrid(grid);
      options.grid.keepBase = choices.yes();
      break;
    }
    default:
      break;
  }
  options.grid.dropNonFinite = choices.yes();
}

void RoundTripInput::chooseMetadata(Choices& choices) {
  if (choices.below(4) != 0) return;
  if (choices.yes()) options.metadata.crs = "EPSG:25832";
  if (choices.yes()) options.metadata.lengthUnit = "m";
  const std::uint64_t entries = choices.below(4);
  for (std::uint64_t e = 0; e < entries; ++e) {
    options.metadata.entries.emplace_back(
        "key " + std::to_string(e), std::string(static_cast<std::size_t>(choices.below(300)), 'x'));
  }
  options.metadata.fieldData = chosenArrays(choices, choices.below(5));
}

void RoundTripInput::choosePoints(Choices& choices) {
  type = positionType(choices);
  const std::uint64_t count = choices.below(choices.yes() ? kMostPoints : 20);
  constexpr std::array<double, 6> kUnits{1, 0.01, 0.125, 1e6, 1e-30, 1.0 / 3};
  const double unit =
      isFloatingPoint(type) ? kUnits[static_cast<std::size_t>(choices.below(6))] : 1;
  const std::uint64_t step = std::uint64_t{2} << choices.below(16);
  const std::uint64_t row = 1 + choices.below(30);
  const auto way = choices.below(4);
  std::array<double, 3> at{};
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t kind = choices.below(16);
    for (std::size_t k = 0; k < 3; ++k) {
      if (kind == 0) break;  // the last point again
      if (kind == 1 && isFloatingPoint(type)) {
        at[k] = type == ScalarType::Float32 ? std::ldexp(static_cast<double>(choices.bits(24)), -60)
                                            : doubleOf(choices.bits(64));
      } else if (kind == 2) {
        at[k] = unit * static_cast<double>(choices.bits(32));
      } else if (way == 0 && k < 2) {
        const std::uint64_t place = k == 0 ? i % row : i / row;
        at[k] = unit * static_cast<double>(place);
      } else {
        at[k] +=
            unit * (static_cast<double>(choices.below(step)) - 0.5 * static_cast<double>(step));
      }
    }
    for (const double x : at) putNumber(positions, type, x);
    if (kind == 1) at = {};
  }
}

void RoundTripInput::chooseCells(Choices& choices) {
  const std::uint64_t points = size();
  if (choices.below(4) != 0) {
    // A net, as regular as the points are, with a few faces missing or turned around.
    const std::uint64_t row = 1 + choices.below(30);
    for (std::uint64_t i = 0; i + row + 1 < points; ++i) {
      if ((i + 1) % row == 0) continue;
      const std::uint64_t kind = choices.below(16);
      const auto a = static_cast<std::uint32_t>(i);
      const auto b = static_cast<std::uint32_t>(i + 1);
      const auto c = static_cast<std::uint32_t>(i + row + 1);
      const auto d = static_cast<std::uint32_t>(i + row);
      if (kind == 0) continue;
      if (kind == 1) {
        cells.faces.add(std::vector<std::uint32_t>{a, b, c, d});
        continue;
      }
      cells.faces.add(kind == 2 ? std::vector<std::uint32_t>{c, b, a}
                                : std::vector<std::uint32_t>{a, b, c});
      cells.faces.add(std::vector<std::uint32_t>{a, c, d});
    }
  }
  for (Cells* sort : {&cells.vertices, &cells.lines, &cells.faces}) {
    if (choices.yes()) continue;
    const std::uint64_t count = choices.below(30);
    for (std::uint64_t i = 0; i < count; ++i) {
      std::vector<std::uint32_t> cell;
      const std::uint64_t corners = choices.below(choices.below(8) == 0 ? 20 : 5);
      for (std::uint64_t j = 0; j < corners; ++j) {
        cell.push_back(static_cast<std::uint32_t>(choices.below(points)));
      }
      sort->add(cell);
    }
  }
}

}  // namespace bspc::fuzz
