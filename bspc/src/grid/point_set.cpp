#include "bspc/point_set.h"

#include "bspc/error.h"
#include "grid/coordinates.h"

namespace bspc {

PointSetView::PointSetView(const void* xyz, ScalarType type, std::uint64_t count,
                           std::size_t strideBytes)
    : data_(xyz), type_(type), count_(count), strideBytes_(strideBytes) {
  const std::size_t packed = 3 * scalarSize(type);
  if (packed == 0) {
    throw Error(ErrorCode::InvalidArgument, std::string("positions cannot be of type ") +
                                                scalarName(type) +
                                                "; give them as one of the ten numeric types");
  }
  if (strideBytes_ == 0) strideBytes_ = packed;
  if (strideBytes_ < packed) {
    throw Error(ErrorCode::InvalidArgument,
                "positions are " + std::to_string(strideBytes) + " bytes apart but three " +
                    scalarName(type) + " numbers take " + std::to_string(packed) +
                    "; give a stride at least that large, or 0 for packed positions");
  }
  if (data_ == nullptr && count_ > 0) {
    throw Error(ErrorCode::InvalidArgument, "positions of " + std::to_string(count) +
                                                " points are at a null address; pass their array");
  }
}

std::array<double, 3> PointSetView::position(std::uint64_t i) const {
  const std::vector<std::uint64_t> all;
  const lattice::ViewCoordinates coordinates(*this, all);
  std::array<double, 3> xyz{};
  for (std::size_t axis = 0; axis < 3; ++axis) coordinates.gather(axis, i, 1, &xyz[axis], 1);
  return xyz;
}

}  // namespace bspc
