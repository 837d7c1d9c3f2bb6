#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/scalar_type.h"
#include "bspc/span.h"

namespace bspc {

/// A point set that somebody else owns: positions of any of the ten numeric types, three numbers a
/// point, in the units of the data, points `strideBytes` apart (0: packed), and named arrays with
/// one tuple a point.
class PointSetView {
 public:
  PointSetView() = default;
  PointSetView(const float* xyz, std::uint64_t count)
      : PointSetView(xyz, ScalarType::Float32, count, 0) {}
  PointSetView(const double* xyz, std::uint64_t count)
      : PointSetView(xyz, ScalarType::Float64, count, 0) {}
  PointSetView(const std::int32_t* xyz, std::uint64_t count)
      : PointSetView(xyz, ScalarType::Int32, count, 0) {}
  /// Throws Error(InvalidArgument) for Bit and String, or for a stride smaller than three numbers.
  PointSetView(const void* xyz, ScalarType type, std::uint64_t count, std::size_t strideBytes);

  std::uint64_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  ScalarType type() const { return type_; }
  const void* data() const { return data_; }
  std::size_t strideBytes() const { return strideBytes_; }

  /// The three coordinates of point `i` as doubles. Integers beyond ±2^53 are rounded.
  std::array<double, 3> position(std::uint64_t i) const;

  Span<const ArrayView> arrays() const { return arrays_; }
  void addArray(ArrayView array) { arrays_.push_back(std::move(array)); }

  /// Makes the points those of a mesh, whose cells must outlive this; nullptr: there are none.
  void setMesh(const MeshCells* mesh) { mesh_ = mesh; }
  const MeshCells* mesh() const { return mesh_; }
  /// Named arrays with one tuple a cell of the mesh: vertex cells, then lines, then faces.
  Span<const ArrayView> cellArrays() const { return cellArrays_; }
  void addCellArray(ArrayView array) { cellArrays_.push_back(std::move(array)); }

 private:
  const void* data_ = nullptr;
  ScalarType type_ = ScalarType::Float32;
  std::uint64_t count_ = 0;
  std::size_t strideBytes_ = 0;
  std::vector<ArrayView> arrays_;
  const MeshCells* mesh_ = nullptr;
  std::vector<ArrayView> cellArrays_;
};

}  // namespace bspc
