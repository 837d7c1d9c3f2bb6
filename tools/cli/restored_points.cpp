#include "cli/restored_points.h"

#include "bspc/error.h"

namespace bspc::cli {

namespace {

template <class T>
void restoreInto(std::vector<std::uint8_t>& bytes, const Grid& grid,
                 const std::vector<GridPoint>& points) {
  // A vector of bytes is aligned for any scalar type: its memory comes from operator new.
  bytes.resize(3 * sizeof(T) * points.size());
  restorePositions(grid, Span<const GridPoint>(points), reinterpret_cast<T*>(bytes.data()));
}

}  // namespace

RestoredPoints::RestoredPoints(const Grid& grid, const DecodedPoints& points)
    : points_(points), type_(grid.scalarType) {
  switch (type_) {
    case ScalarType::Float32:
      restoreInto<float>(coordinates_, grid, points.points);
      return;
    case ScalarType::Float64:
      restoreInto<double>(coordinates_, grid, points.points);
      return;
    case ScalarType::Int8:
      restoreInto<std::int8_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::UInt8:
      restoreInto<std::uint8_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::Int16:
      restoreInto<std::int16_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::UInt16:
      restoreInto<std::uint16_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::Int32:
      restoreInto<std::int32_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::UInt32:
      restoreInto<std::uint32_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::Int64:
      restoreInto<std::int64_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::UInt64:
      restoreInto<std::uint64_t>(coordinates_, grid, points.points);
      return;
    case ScalarType::Bit:
    case ScalarType::String:
      break;
  }
  throw Error(ErrorCode::InvalidArgument, "positions cannot be bits or strings");
}

formats::ModelView RestoredPoints::model() const {
  formats::ModelView view;
  view.points = PointSetView(coordinates_.data(), type_, points_.points.size(), 0);
  if (!points_.counts.empty()) view.columns.push_back({"PointCount", points_.counts});
  if (!points_.cellIds.empty()) view.columns.push_back({"CellId", points_.cellIds});
  return view;
}

}  // namespace bspc::cli
