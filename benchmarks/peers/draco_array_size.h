#pragma once

#include <cstddef>
#include <optional>

class vtkAbstractArray;
class vtkPolyData;

namespace bspc {

/// Bytes that Draco takes for the points, whose coordinates must lie on a lattice, and an array
/// (null: none), coded as a kd-tree or one after the other, at its greatest effort. Empty if it
/// cannot code that or does not give all of it back.
std::optional<std::size_t> dracoSize(vtkPolyData* data, vtkAbstractArray* array, bool kdTree);

}  // namespace bspc
