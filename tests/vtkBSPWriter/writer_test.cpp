// vtkBSPWriter: which data it takes, what it refuses, and what is on disk afterwards.

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSphereSource.h>
#include <vtkStructuredGrid.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/point_sets.h"
#include "vtkBSPReader.h"
#include "vtkBSPWriter.h"
#include "vtkErrorCode.h"
#include "vtk_support/vtk_test_support.h"

namespace bspc::test {
namespace {

class Writer : public testing::Test {
 protected:
  void SetUp() override {
    input_ = pointsOnly(scannedSphere(3, 3000, 1023));
    writer_->WriteToOutputStringOn();
  }

  /// What is said when that is written; expects that nothing is.
  std::string complaintAbout(vtkDataObject* input) {
    const ErrorLog log(writer_);
    writer_->SetInputData(input);
    EXPECT_EQ(writer_->Write(), 0);
    EXPECT_EQ(writer_->GetOutputString(), "");
    writer_->RemoveObservers(vtkCommand::ErrorEvent);
    writer_->GetExecutive()->RemoveObservers(vtkCommand::ErrorEvent);
    return log.first();
  }

  vtkPolyData* readBack() { return readBytes(writer_->GetOutputString(), reader_); }

  vtkSmartPointer<vtkPolyData> input_;
  vtkNew<vtkBSPWriter> writer_;
  vtkNew<vtkBSPReader> reader_;
};

TEST_F(Writer, AFileAndBytesInMemoryAreTheSame) {
  const TemporaryFolder folder;
  const std::string bytes = written(input_, writer_);
  writer_->WriteToOutputStringOff();
  writer_->SetFileName((folder / "sphere.bspc").c_str());
  ASSERT_EQ(writer_->Write(), 1);
  EXPECT_EQ(bytesOf(folder / "sphere.bspc"), bytes);
  EXPECT_EQ(writer_->GetOutputString(), "");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"sphere.bspc"});
  EXPECT_EQ(writer_->GetNumberOfPointsWritten(), 3000);
  EXPECT_EQ(writer_->GetNumberOfBytesWritten(), static_cast<vtkIdType>(bytes.size()));
  EXPECT_TRUE(writer_->GetExact());
}

TEST_F(Writer, PlacesThatCannotBeWrittenAreErrors) {
  const TemporaryFolder folder;
  const auto codeOf = [this](const std::string& fileName) {
    vtkNew<vtkBSPWriter> writer;
    const ErrorLog log(writer);
    writer->SetInputData(input_);
    if (!fileName.empty()) writer->SetFileName(fileName.c_str());
    EXPECT_EQ(writer->Write(), 0);
    EXPECT_NE(log.first().find(fileName), std::string::npos) << log.first();
    return writer->GetErrorCode();
  };
  EXPECT_EQ(codeOf(""), vtkErrorCode::NoFileNameError);
  EXPECT_EQ(codeOf(folder / "no/such/folder.bspc"), vtkErrorCode::CannotOpenFileError);
  EXPECT_EQ(codeOf(folder / ""), vtkErrorCode::CannotOpenFileError);
  EXPECT_EQ(codeOf("/dev/full"), vtkErrorCode::OutOfDiskSpaceError);
  EXPECT_TRUE(folder.names().empty());
}

TEST_F(Writer, AnOldFileStaysUnlessTheNewOneIsWhole) {
  const TemporaryFolder folder;
  writeBytes(folder / "old.bspc", "old");
  writer_->WriteToOutputStringOff();
  writer_->SetFileName((folder / "old.bspc").c_str());
  writer_->SetMethod("no such method");
  EXPECT_NE(complaintAbout(input_).find("no such method"), std::string::npos);
  EXPECT_EQ(bytesOf(folder / "old.bspc"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"old.bspc"});

  writer_->SetMethod("kd");
  ASSERT_EQ(writer_->Write(), 1);
  EXPECT_GT(bytesOf(folder / "old.bspc").size(), 100U);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"old.bspc"});
}

TEST_F(Writer, AbortWritesNothingAndIsNoError) {
  struct Watch {
    void call() {
      EXPECT_GE(writer->GetProgress(), last);
      last = writer->GetProgress();
      if (last >= stopAt) writer->SetAbortExecute(1);
    }
    vtkBSPWriter* writer;
    double stopAt;
    double last = 0;
  };
  const TemporaryFolder folder;
  writeBytes(folder / "old.bspc", "old");
  writer_->WriteToOutputStringOff();
  writer_->SetInputData(input_);
  writer_->SetFileName((folder / "old.bspc").c_str());
  Watch stopping{writer_, 0.1};
  const unsigned long tag =
      writer_->AddObserver(vtkCommand::ProgressEvent, &stopping, &Watch::call);
  const ErrorLog log(writer_);
  EXPECT_EQ(writer_->Write(), 0);
  EXPECT_EQ(writer_->GetErrorCode(), 0U);
  EXPECT_EQ(log.first(), "");
  EXPECT_EQ(bytesOf(folder / "old.bspc"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"old.bspc"});

  writer_->SetAbortExecute(0);
  writer_->RemoveObserver(tag);
  Watch watching{writer_, 2};
  writer_->AddObserver(vtkCommand::ProgressEvent, &watching, &Watch::call);
  EXPECT_EQ(writer_->Write(), 1);
  EXPECT_EQ(watching.last, 1);
}

TEST_F(Writer, GridModesBoundTheError) {
  const auto input =
      pointsOnly({{0.1, 0.2, 0.3}, {10.17, 3.1, 2.7}, {5.123456789, 1e-3, 9}}, VTK_DOUBLE);
  writer_->SetGridModeToPrecision();
  writer_->SetPrecision(0.01);
  written(input, writer_);
  EXPECT_FALSE(writer_->GetExact());
  for (int k = 0; k < 3; ++k) EXPECT_LE(writer_->GetMaximumError()[k], 0.0050001);
  writer_->SetGridModeToBits();
  writer_->SetBits(8);
  const std::size_t coarse = written(input, writer_).size();
  EXPECT_GT(writer_->GetMaximumError()[0], 0.001);
  EXPECT_LE(writer_->GetMaximumError()[0], 10.07 / 255);
  writer_->SetBits(30);
  EXPECT_GT(written(input, writer_).size(), coarse);
  EXPECT_LE(writer_->GetMaximumError()[0], 1e-8);
  writer_->SetGridModeToPrecision();
  writer_->SetPrecision(-1);
  EXPECT_NE(complaintAbout(input), "");
}

TEST_F(Writer, TheExactModeKeepsEveryBit) {
  writer_->SetGridModeToExact();
  std::mt19937_64 random(3);
  std::vector<std::array<double, 3>> points = {{-0.0, 0.0, 5e-324}, {1e300, -1e-300, 0.1}};
  for (int i = 0; i < 500; ++i) {
    points.push_back({std::ldexp(static_cast<double>(random()), static_cast<int>(i % 90) - 100),
                      -static_cast<double>(random()) / 3, static_cast<double>(i) / 7});
  }
  for (const int type : {VTK_DOUBLE, VTK_FLOAT}) {
    if (type == VTK_FLOAT) points.erase(points.begin(), points.begin() + 2);
    const auto input = pointsOnly(points, type);
    written(input, writer_);
    vtkPolyData* output = readBack();
    EXPECT_EQ(output->GetPoints()->GetDataType(), type);
    EXPECT_EQ(sortedPositions(output), sortedPositions(input));
    for (int i = 0; i < 6; ++i) {
      const double bound = reader_->GetBoundsOfFile()[i];
      EXPECT_TRUE(i % 2 == 0 ? bound <= input->GetBounds()[i] : bound >= input->GetBounds()[i]);
    }
  }
}

TEST_F(Writer, PointSetsOfEveryKindAreTaken) {
  vtkNew<vtkPointSet> bare;
  bare->SetPoints(input_->GetPoints());
  written(bare, writer_);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));

  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(input_->GetPoints());
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    grid->InsertNextCell(VTK_VERTEX, 1, &i);
  }
  written(grid, writer_);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));

  // Coordinates that do not lie side by side.
  vtkNew<vtkSOADataArrayTemplate<double>> apart;
  apart->SetNumberOfComponents(3);
  apart->DeepCopy(input_->GetPoints()->GetData());
  vtkNew<vtkPoints> points;
  points->SetData(apart);
  bare->SetPoints(points);
  written(bare, writer_);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));
}

TEST_F(Writer, NoPointsComeBackAsNoPoints) {
  vtkNew<vtkPolyData> empty;
  written(empty, writer_);
  EXPECT_EQ(readBack()->GetNumberOfPoints(), 0);
  EXPECT_EQ(reader_->GetNumberOfPointsInFile(), 0);
}

TEST_F(Writer, ATableWithColumnsOfCoordinatesIsTaken) {
  vtkNew<vtkTable> table;
  for (const char* name : {"Y", "x", "z"}) {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    for (int i = 0; i < 4; ++i) column->InsertNextValue(*name == 'x' ? i : *name == 'Y' ? 10 : 20);
    table->AddColumn(column);
  }
  written(table, writer_);
  const std::vector<std::array<double, 3>> expected = {
      {0, 10, 20}, {1, 10, 20}, {2, 10, 20}, {3, 10, 20}};
  EXPECT_EQ(sortedPositions(readBack()), expected);
  EXPECT_EQ(readBack()->GetPoints()->GetDataType(), VTK_DOUBLE);
  table->RemoveColumnByName("z");
  EXPECT_NE(complaintAbout(table).find("called z"), std::string::npos);
}

/// The corners of every cell in turn, with what an array says of the cell.
std::vector<std::vector<std::array<double, 3>>> cellsOf(vtkPolyData* mesh, const char* array) {
  std::vector<std::vector<std::array<double, 3>>> cells;
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
    vtkNew<vtkIdList> ids;
    mesh->GetCellPoints(i, ids);
    cells.emplace_back();
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) {
      cells.back().emplace_back();
      mesh->GetPoint(ids->GetId(k), cells.back().back().data());
    }
    // Faces begin anywhere: with their least corner here.
    std::rotate(cells.back().begin(), std::min_element(cells.back().begin(), cells.back().end()),
                cells.back().end());
    cells.back().push_back({mesh->GetCellData()->GetArray(array)->GetComponent(i, 0), 0, 0});
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

TEST_F(Writer, MeshesComeBackWithTheirCellsAndTheirArrays) {
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(20);
  sphere->SetPhiResolution(15);
  sphere->Update();
  vtkPolyData* mesh = sphere->GetOutput();
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Number");
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
    numbers->InsertNextValue(static_cast<int>(i * 7 % 1000));
  }
  mesh->GetCellData()->AddArray(numbers);
  writer_->SetGridModeToExact();
  written(mesh, writer_);
  vtkPolyData* output = readBack();
  EXPECT_EQ(output->GetNumberOfPolys(), mesh->GetNumberOfPolys());
  EXPECT_EQ(output->GetNumberOfVerts(), 0);
  EXPECT_EQ(sortedPositions(output), sortedPositions(mesh));
  ASSERT_TRUE(output->GetCellData()->HasArray("Number"));
  EXPECT_EQ(cellsOf(output, "Number"), cellsOf(mesh, "Number"));
  EXPECT_NE(output->GetPointData()->GetNormals(), nullptr);

  // Pieces: the first has all of it. A box has points only.
  reader_->UpdatePiece(0, 3, 0);
  EXPECT_EQ(output->GetNumberOfPolys(), mesh->GetNumberOfPolys());
  reader_->UpdatePiece(1, 3, 0);
  EXPECT_EQ(output->GetNumberOfPoints(), 0);
  reader_->UseBoxOn();
  reader_->SetBox(0, 1, -1, 1, -1, 1);
  reader_->UpdatePiece(0, 1, 0);
  EXPECT_EQ(output->GetNumberOfPolys(), 0);
  EXPECT_GT(output->GetNumberOfVerts(), 50);
  EXPECT_LT(output->GetNumberOfVerts(), mesh->GetNumberOfPoints());
}

TEST_F(Writer, CellsAreRefusedUnlessTheyMayBeDropped) {
  const vtkIdType triangle[3] = {0, 1, 2};
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell(3, triangle);
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(input_->GetPoints());
  mesh->SetStrips(strips);
  EXPECT_NE(complaintAbout(mesh).find("triangle strips"), std::string::npos);
  EXPECT_EQ(writer_->GetErrorCode(), vtkErrorCode::FileFormatError);

  vtkNew<vtkStructuredGrid> structured;
  structured->SetDimensions(10, 10, 30);
  structured->SetPoints(input_->GetPoints());
  EXPECT_NE(complaintAbout(structured).find("vtkHexahedron"), std::string::npos);

  writer_->DropCellsOn();
  written(mesh, writer_);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));
  written(structured, writer_);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));
}

TEST_F(Writer, VerticesThatHaveArraysAreKept) {
  vtkNew<vtkFloatArray> quality;
  quality->SetName("Quality");
  quality->InsertNextValue(1);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell(1);
  verts->InsertCellPoint(0);
  input_->SetVerts(verts);
  input_->GetCellData()->AddArray(quality);
  written(input_, writer_);
  EXPECT_EQ(readBack()->GetNumberOfVerts(), 1);
  EXPECT_TRUE(readBack()->GetCellData()->HasArray("Quality"));
  writer_->DropCellsOn();
  written(input_, writer_);
  EXPECT_EQ(readBack()->GetNumberOfVerts(), 3000);
}

TEST_F(Writer, InputsThatAreNoPointsAreRefused) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(2, 2, 2);
  const ErrorLog log(writer_);
  writer_->SetInputData(image);
  EXPECT_EQ(writer_->Write(), 0);
  EXPECT_NE(log.first(), "");
  EXPECT_EQ(writer_->GetOutputString(), "");
}

TEST_F(Writer, GhostPointsAreLeftOut) {
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  std::vector<std::array<double, 3>> kept;
  for (vtkIdType i = 0; i < input_->GetNumberOfPoints(); ++i) {
    const auto mark = static_cast<unsigned char>(i % 3 == 0   ? vtkDataSetAttributes::DUPLICATEPOINT
                                                 : i % 7 == 0 ? vtkDataSetAttributes::HIDDENPOINT
                                                              : 0);
    ghosts->InsertNextValue(mark);
    if (mark != 0) continue;
    kept.emplace_back();
    input_->GetPoint(i, kept.back().data());
  }
  std::sort(kept.begin(), kept.end());
  input_->GetPointData()->AddArray(ghosts);
  written(input_, writer_);
  EXPECT_EQ(sortedPositions(readBack()), kept);
  EXPECT_EQ(readBack()->GetPointData()->GetNumberOfArrays(), 0);
  ghosts->FillValue(0);
  written(input_, writer_);
  EXPECT_EQ(readBack()->GetNumberOfPoints(), 3000);
}

TEST_F(Writer, PointsWithoutAPlaceAreRefusedUnlessTheyMayBeDropped) {
  input_->GetPoints()->SetPoint(17, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_NE(complaintAbout(input_).find("17"), std::string::npos);
  writer_->DropNonFiniteOn();
  written(input_, writer_);
  EXPECT_EQ(readBack()->GetNumberOfPoints(), 2999);
}

TEST_F(Writer, TheStreamingLayoutReadsBackTheSame) {
  const std::string progressive = written(input_, writer_);
  writer_->SetLayoutToStreaming();
  EXPECT_NE(written(input_, writer_), progressive);
  EXPECT_EQ(sortedPositions(readBack()), sortedPositions(input_));
}

}  // namespace
}  // namespace bspc::test
