#include "vtk_support/vtk_test_support.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkPoints.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace bspc::test {

namespace {

/// Turns calls of a VTK observer into messages.
void note(vtkObject* /*caller*/, unsigned long /*event*/, void* messages, void* text) {
  const std::string all = static_cast<const char*>(text);
  const std::size_t address = all.find("): ");
  const std::string message = address == std::string::npos ? all : all.substr(address + 3);
  const std::size_t end = message.find_last_not_of('\n');
  static_cast<std::vector<std::string>*>(messages)->push_back(message.substr(0, end + 1));
}

}  // namespace

ErrorLog::ErrorLog(vtkAlgorithm* algorithm) {
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(note);
  command->SetClientData(&messages_);
  algorithm->AddObserver(vtkCommand::ErrorEvent, command);
  algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, command);
}

vtkSmartPointer<vtkPolyData> pointsOnly(const std::vector<std::array<double, 3>>& points,
                                        int vtkType) {
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataType(vtkType);
  for (const auto& p : points) coordinates->InsertNextPoint(p.data());
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(coordinates);
  return data;
}

vtkSmartPointer<vtkPolyData> pointsOnly(const std::vector<GridPoint>& points) {
  std::vector<std::array<double, 3>> coordinates;
  coordinates.reserve(points.size());
  for (const GridPoint& p : points) {
    coordinates.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  return pointsOnly(coordinates, VTK_FLOAT);
}

std::vector<std::array<double, 3>> sortedPositions(vtkPointSet* points) {
  std::vector<std::array<double, 3>> positions(
      static_cast<std::size_t>(points->GetNumberOfPoints()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    points->GetPoint(static_cast<vtkIdType>(i), positions[i].data());
  }
  std::sort(positions.begin(), positions.end());
  return positions;
}

std::string written(vtkDataObject* input, vtkBSPWriter* writer) {
  const ErrorLog log(writer);
  writer->SetInputData(input);
  writer->WriteToOutputStringOn();
  EXPECT_EQ(writer->Write(), 1) << log.first();
  writer->RemoveObservers(vtkCommand::ErrorEvent);
  writer->GetExecutive()->RemoveObservers(vtkCommand::ErrorEvent);
  return writer->GetOutputString();
}

std::string written(vtkDataObject* input) {
  vtkNew<vtkBSPWriter> writer;
  return written(input, writer);
}

vtkPolyData* readBytes(const std::string& bytes, vtkBSPReader* reader) {
  const ErrorLog log(reader);
  reader->ReadFromInputStringOn();
  reader->SetInputString(bytes);
  reader->Update();
  EXPECT_EQ(log.first(), "");
  EXPECT_EQ(reader->GetErrorCode(), 0U);
  reader->RemoveObservers(vtkCommand::ErrorEvent);
  reader->GetExecutive()->RemoveObservers(vtkCommand::ErrorEvent);
  return reader->GetOutput();
}

TemporaryFolder::TemporaryFolder() {
  std::string name = testing::TempDir() + "bspc_vtk_XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void writeBytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace bspc::test
