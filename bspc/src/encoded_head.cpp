#include "encoded_head.h"

#include "bspc/error.h"
#include "grid/float_grid.h"

namespace bspc {

container::FileHead beginFile(const ArraySource& arrays, const EncodeOptions& options,
                              EncodeReport& report) {
  container::FileHead head;
  head.layers = report.layers;
  head.grid = report.grid;
  head.keepsOrder = options.keepOrder;
  head.metadata = options.metadata;
  for (std::size_t a = arrays.hidden(); a < arrays.size(); ++a) {
    head.arrays.push_back(arrays.description(a));
    report.arrays.push_back({head.arrays.back().name, 0, 0});
  }
  return head;
}

void refuseStopsOnFloats(const Grid& grid, const EncodeOptions& options) {
  if (!lattice::isFloatGrid(grid) || (options.stopPoints == 0 && !options.stopLevel)) return;
  throw Error(ErrorCode::InvalidArgument,
              "a lossy coding of exact floats contradicts itself; leave one of the two out");
}

}  // namespace bspc
