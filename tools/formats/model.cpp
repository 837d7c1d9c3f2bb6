#include "formats/model.h"

namespace bspc::formats {

PointSetView Model::view() const {
  PointSetView view(positions.data(), type, size(), 0);
  for (const ArrayValues& array : values) view.addArray(array.view());
  return view;
}

}  // namespace bspc::formats
