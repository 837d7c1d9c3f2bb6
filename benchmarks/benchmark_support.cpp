#include "benchmark_support.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "bspc/encoder.h"
#include "formats/model_io.h"

namespace bspc {

Coordinates readOnLattice(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot be opened");
  const formats::Model model = formats::readModel(file, formats::Format::Ply);
  const GridFit fit = fitGrid(model.view(), GridRequest::automatic());
  if (!fit.exact || fit.points.empty()) throw std::runtime_error("lies on no lattice");
  Coordinates xyz;
  xyz.reserve(3 * fit.points.size());
  for (const GridPoint& point : fit.points) {
    for (const std::uint32_t index : point) {
      if (index > INT32_MAX) throw std::runtime_error("takes more than 31 bits along an axis");
      xyz.push_back(static_cast<std::int32_t>(index));
    }
  }
  return xyz;
}

std::vector<std::array<std::int32_t, 3>> sortedPoints(const Coordinates& xyz) {
  std::vector<std::array<std::int32_t, 3>> points(xyz.size() / 3);
  std::memcpy(points.data(), xyz.data(), xyz.size() * sizeof(xyz[0]));
  std::sort(points.begin(), points.end());
  return points;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string modelName(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  return name.substr(0, name.rfind('.'));
}

}  // namespace bspc
