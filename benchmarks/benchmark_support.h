#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

namespace bspc {

/// Three whole numbers a point.
using Coordinates = std::vector<std::int32_t>;

/// A PLY model's points as steps of the lattice that they lie on. Throws std::runtime_error if
/// there is none, or none of at most 31 bits along every axis.
Coordinates readOnLattice(const std::string& path);

std::vector<std::array<std::int32_t, 3>> sortedPoints(const Coordinates& xyz);

/// Of at least one value.
double median(std::vector<double> values);

/// Processor time, which other processes disturb least.
template <class Call>
double secondsOf(const Call& call) {
  const std::clock_t start = std::clock();
  call();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// A path's last part without the ending.
std::string modelName(const std::string& path);

}  // namespace bspc
