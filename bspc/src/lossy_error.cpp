#include "lossy_error.h"

#include <algorithm>
#include <cmath>

namespace bspc {

void addLossyError(const PointSetView& points, const std::vector<std::uint64_t>& sources,
                   const std::vector<GridPoint>& decoded, const GridPoint& lower,
                   EncodeReport& report) {
  for (std::size_t j = 0; j < sources.size(); ++j) {
    const std::array<double, 3> given = points.position(sources[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double restored =
          restoredCoordinate(report.grid, static_cast<int>(k), lower[k] + decoded[j][k]);
      const double error = std::abs(restored - given[k]);
      report.maxError[k] = std::max(report.maxError[k], error);
      if (error > 0) report.exact = false;
    }
  }
}

}  // namespace bspc
