#include "cli/whole_points.h"

#include <algorithm>

#include "formats/array_tuples.h"

namespace bspc::cli {

WholePoints::WholePoints(ModelPoints& points, std::uint64_t most)
    : type_(points.type()), values_(formats::emptyArrays(points.arrays())) {
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
  const std::size_t pointBytes = 3 * scalarSize(type_);
  for (std::size_t got = 1; got > 0 && size() < most;) {
    const std::size_t before = positions_.size();
    const auto wanted = static_cast<std::size_t>(std::min(kBlock, most - size()));
    positions_.resize(before + wanted * pointBytes);
    got = points.read(positions_.data() + before, values_, wanted);
    positions_.resize(before + got * pointBytes);
  }
  if (!points.ended()) {
    std::vector<std::uint8_t> further(pointBytes);
    std::vector<ArrayValues> values = formats::emptyArrays(points.arrays());
    isCut_ = points.read(further.data(), values, 1) > 0;
  }
  if (!isCut_) mesh_ = points.takeMesh();
}

PointSetView WholePoints::view() const {
  PointSetView view(positions_.data(), type_, size(), 0);
  for (const ArrayValues& array : values_) view.addArray(array.view());
  if (!mesh_.empty()) view.setMesh(&mesh_);
  return view;
}

}  // namespace bspc::cli
