#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/mesh.h"

namespace bspc::bench {

/// Vertices and polygons of an OFF file.
struct OffModel {
  std::vector<float> xyz;
  MeshCells cells;

  std::uint64_t points() const { return xyz.size() / 3; }
};

/// Throws std::runtime_error for files that are none or use vertices that there are not.
OffModel readOff(const std::string& name);

/// The same with polygons cut into fans of triangles.
OffModel inTriangles(const OffModel& model);

/// The name of a file without its folders.
std::string baseName(const std::string& path);

}  // namespace bspc::bench
