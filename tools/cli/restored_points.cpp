#include "cli/restored_points.h"

#include <cstddef>
#include <cstring>

#include "bspc/error.h"

namespace bspc::cli {

namespace {

template <class T>
void restoreInto(std::vector<std::uint8_t>& bytes, const Grid& grid, const DecodedPoints& points) {
  // A vector of bytes is aligned for any scalar type: its memory comes from operator new.
  bytes.resize(3 * sizeof(T) * points.points.size());
  restorePositions(grid, points, reinterpret_cast<T*>(bytes.data()));
}

template <class T>
void appendNumbers(Bytes& bytes, const std::vector<std::uint64_t>& numbers) {
  bytes.resize(numbers.size() * sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const T number = static_cast<T>(numbers[i]);
    std::memcpy(bytes.data() + i * sizeof(T), &number, sizeof(T));
  }
}

ArrayValues numbersOf(const ArrayDescription& description,
                      const std::vector<std::uint64_t>& numbers) {
  ArrayValues array;
  static_cast<ArrayDescription&>(array) = description;
  if (description.type == ScalarType::UInt32) {
    appendNumbers<std::uint32_t>(array.values, numbers);
  } else {
    appendNumbers<std::uint64_t>(array.values, numbers);
  }
  return array;
}

}  // namespace

RestoredPoints::RestoredPoints(const FileInfo& info, const DecodedPoints& points)
    : points_(points), type_(info.grid.scalarType) {
  if (!points.counts.empty()) {
    numbers_.push_back(numbersOf(countsDescription(info.points), points.counts));
  }
  if (!points.cellIds.empty()) {
    numbers_.push_back(numbersOf(cellIdsDescription(info.points), points.cellIds));
  }
  const Grid& grid = info.grid;
  switch (type_) {
    case ScalarType::Float32:
      restoreInto<float>(coordinates_, grid, points);
      return;
    case ScalarType::Float64:
      restoreInto<double>(coordinates_, grid, points);
      return;
    case ScalarType::Int8:
      restoreInto<std::int8_t>(coordinates_, grid, points);
      return;
    case ScalarType::UInt8:
      restoreInto<std::uint8_t>(coordinates_, grid, points);
      return;
    case ScalarType::Int16:
      restoreInto<std::int16_t>(coordinates_, grid, points);
      return;
    case ScalarType::UInt16:
      restoreInto<std::uint16_t>(coordinates_, grid, points);
      return;
    case ScalarType::Int32:
      restoreInto<std::int32_t>(coordinates_, grid, points);
      return;
    case ScalarType::UInt32:
      restoreInto<std::uint32_t>(coordinates_, grid, points);
      return;
    case ScalarType::Int64:
      restoreInto<std::int64_t>(coordinates_, grid, points);
      return;
    case ScalarType::UInt64:
      restoreInto<std::uint64_t>(coordinates_, grid, points);
      return;
    case ScalarType::Bit:
    case ScalarType::String:
      break;
  }
  throw Error(ErrorCode::InvalidArgument, "positions cannot be bits or strings");
}

PointSetView RestoredPoints::view() const {
  PointSetView view(coordinates_.data(), type_, points_.points.size(), 0);
  for (const ArrayValues& array : points_.arrays) view.addArray(array.view());
  for (const ArrayValues& array : numbers_) view.addArray(array.view());
  return view;
}

ArrayDescription countsDescription(std::uint64_t points) {
  ArrayDescription description;
  description.name = "PointCount";
  description.type = points <= UINT32_MAX ? ScalarType::UInt32 : ScalarType::UInt64;
  return description;
}

ArrayDescription cellIdsDescription(std::uint64_t points) {
  ArrayDescription description = countsDescription(points);
  description.name = "CellId";
  return description;
}

}  // namespace bspc::cli
