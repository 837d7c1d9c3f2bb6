#pragma once

#include <string>
#include <vector>

#include "attributes/array_coder.h"
#include "bspc/grid.h"

namespace bspc::benchmarks {

/// An array of a set, its tuples in the order of the input.
struct NamedArray {
  std::string name;
  attributes::ArrayShape shape;
  attributes::ArrayValues values;
};

/// Points on their grid and what is known of each.
struct ArraySet {
  std::string name;
  std::vector<GridPoint> points;
  std::vector<NamedArray> arrays;
};

/// Reads what a benchmark of arrays needs, and no more, of
/// - LAS files of point format 3: intensity, return bits, classification, scan angle, user data,
///   GPS time, RGB;
/// - PCD files of fields x y z rgb, binary_compressed: RGB, positions in millimetres;
/// - OBJ files: positions of 12 bits, and arrays that are made of vertices and faces: normals, a
///   smooth function of the position (float32 and float64), mean curvature, random integers.
/// Throws std::runtime_error for anything else.
ArraySet readArraySet(const std::string& path);

}  // namespace bspc::benchmarks
