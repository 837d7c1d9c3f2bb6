#include "formats/model.h"

namespace bspc::formats {

PointSetView Model::view() const {
  PointSetView view(positions.data(), type, size(), 0);
  for (const ArrayValues& array : values) view.addArray(array.view());
  if (!mesh.empty()) view.setMesh(&mesh);
  return view;
}

}  // namespace bspc::formats
