#pragma once

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bspc/grid.h"
#include "vtkBSPReader.h"
#include "vtkBSPWriter.h"

namespace bspc::test {

/// Collects what an algorithm and its executive report as errors, instead of printing it.
class ErrorLog {
 public:
  explicit ErrorLog(vtkAlgorithm* algorithm);
  /// The first message, without VTK's address of the object; empty if there was none.
  std::string first() const { return messages_.empty() ? std::string() : messages_.front(); }

 private:
  std::vector<std::string> messages_;
};

/// Poly data of points as float coordinates.
vtkSmartPointer<vtkPolyData> pointsOnly(const std::vector<GridPoint>& points);

/// Poly data of points, coordinates of that type.
vtkSmartPointer<vtkPolyData> pointsOnly(const std::vector<std::array<double, 3>>& points,
                                        int vtkType);

/// Positions in ascending order.
std::vector<std::array<double, 3>> sortedPositions(vtkPointSet* points);

/// What a writer writes of an input; expects it to succeed.
std::string written(vtkDataObject* input, vtkBSPWriter* writer);
std::string written(vtkDataObject* input);

/// Reads bytes with the settings of a reader; expects it to succeed.
vtkPolyData* readBytes(const std::string& bytes, vtkBSPReader* reader);

/// A folder for the files of one test, gone with this.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of the files that are in it.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

void writeBytes(const std::string& path, const std::string& bytes);
std::string bytesOf(const std::string& path);

}  // namespace bspc::test
