#pragma once

#include <vtkAbstractArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "bspc/decoder.h"

namespace bspc::vtk {

/// The VTK type for coordinates of that file: VTK_FLOAT where it holds all of them, else
/// VTK_DOUBLE.
int coordinateType(const FileInfo& info);

/// Grows VTK arrays tile by tile, and makes a vtkPolyData of them in the end.
class PolyDataBuilder {
 public:
  struct Options {
    std::vector<ArrayInfo> arrays;  ///< those that are decoded, in the order of FileInfo::arrays
    bool cellIds = false;
    bool counts = false;
    bool vertices = true;
    std::uint64_t memoryBytes = 0;  ///< the most that the output may take
  };

  /// The information must outlive this. Throws Error(InvalidArgument) if an array of the file has
  /// the name of one that is made.
  PolyDataBuilder(const FileInfo& info, Options options);

  /// Throws Error(LimitExceeded) if that would make the output larger than the options allow.
  void append(const DecodedPoints& tile);
  /// Hands everything over to an empty poly data; with the cells of a mesh instead of vertices if
  /// there are some.
  void finish(vtkPolyData* output, const DecodedPoints* mesh = nullptr);

 private:
  void checkMemory(const DecodedPoints& tile);
  void appendCoordinates(const DecodedPoints& tile);

  const FileInfo& info_;
  Options options_;
  std::uint64_t bytes_ = 0;
  vtkSmartPointer<vtkDataArray> coordinates_;
  std::vector<vtkSmartPointer<vtkAbstractArray>> arrays_;  ///< as in Options::arrays
  vtkSmartPointer<vtkAbstractArray> cellIds_;
  vtkSmartPointer<vtkAbstractArray> counts_;
};

}  // namespace bspc::vtk
