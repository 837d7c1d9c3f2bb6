#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bspc {

/// How the positions of a tile are coded. The values are those of the file format.
enum class Method : std::uint8_t {
  Kd = 1,          ///< kd-tree with point counts (Gandoin and Devillers 2002), adaptive models
  Fast = 2,        ///< slabs of points with predicted heights, quick to code
  Bsp = 3,         ///< oriented cut planes with point counts (Bordignon et al. 2006)
  Octree = 4,      ///< octree occupancy (Botsch et al. 2002)
  GenCode = 5,     ///< kd-tree with the symbols 0, 1, + (Lewiner et al. 2006)
  Predictive = 6,  ///< octree with every decision predicted from what is around, the smallest files
  Surface = 7,     ///< vertex after vertex along the faces of a mesh
};

/// Name as spelt on the command line ("kd", "fast"), and back; empty if there is no such method.
const char* methodName(Method method);
std::optional<Method> methodFromName(const std::string& name);

/// Every method that this version can encode and decode.
std::vector<Method> availableMethods();

}  // namespace bspc
