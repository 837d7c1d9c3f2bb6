// vtkBSPReader: what a VTK pipeline gets from a file, or from bytes in memory.

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <set>

#include "support/point_sets.h"
#include "vtkBSPReader.h"
#include "vtkBSPWriter.h"
#include "vtkErrorCode.h"
#include "vtk_support/vtk_test_support.h"

namespace bspc::test {
namespace {

/// A bumpy sphere in 30 tiles and three levels.
class Reader : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    input_ = pointsOnly(scannedSphere(5, 30000, 4095));
    vtkNew<vtkBSPWriter> writer;
    writer->SetPointsPerTile(1000);
    writer->SetNumberOfLevels(3);
    bytes_ = written(input_, writer);
  }
  static void TearDownTestSuite() { input_ = nullptr; }

  static vtkSmartPointer<vtkPolyData> input_;
  static std::string bytes_;
  vtkNew<vtkBSPReader> reader_;
};

vtkSmartPointer<vtkPolyData> Reader::input_;
std::string Reader::bytes_;

TEST_F(Reader, AFileGivesItsPointsWithOneVertexEach) {
  const TemporaryFolder folder;
  writeBytes(folder / "sphere.bspc", bytes_);
  EXPECT_EQ(vtkBSPReader::CanReadFile((folder / "sphere.bspc").c_str()), 1);
  reader_->SetFileName((folder / "sphere.bspc").c_str());
  reader_->Update();
  EXPECT_EQ(reader_->GetErrorCode(), 0U);
  vtkPolyData* output = reader_->GetOutput();
  EXPECT_EQ(sortedPositions(output), sortedPositions(input_));
  ASSERT_EQ(output->GetNumberOfVerts(), input_->GetNumberOfPoints());
  EXPECT_EQ(output->GetNumberOfCells(), input_->GetNumberOfPoints());
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  output->GetVerts()->GetCellAtId(1234, count, ids);
  EXPECT_EQ(count, 1);
  EXPECT_EQ(ids[0], 1234);
}

TEST_F(Reader, BytesInMemoryGiveTheSame) {
  vtkPolyData* output = readBytes(bytes_, reader_);
  EXPECT_EQ(sortedPositions(output), sortedPositions(input_));
  reader_->GenerateVerticesOff();
  reader_->Update();
  EXPECT_EQ(output->GetNumberOfCells(), 0);
  EXPECT_EQ(output->GetNumberOfPoints(), input_->GetNumberOfPoints());
}

TEST_F(Reader, FilesThatCannotBeReadAreErrors) {
  const TemporaryFolder folder;
  writeBytes(folder / "other.bspc", "ply\nformat ascii 1.0\n");
  EXPECT_EQ(vtkBSPReader::CanReadFile((folder / "other.bspc").c_str()), 0);
  EXPECT_EQ(vtkBSPReader::CanReadFile((folder / "none.bspc").c_str()), 0);
  EXPECT_EQ(vtkBSPReader::CanReadFile(nullptr), 0);
  const auto codeOf = [](const std::string& fileName) {
    vtkNew<vtkBSPReader> reader;
    const ErrorLog log(reader);
    if (!fileName.empty()) reader->SetFileName(fileName.c_str());
    reader->Update();
    EXPECT_NE(log.first().find(fileName), std::string::npos) << log.first();
    EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
    return reader->GetErrorCode();
  };
  EXPECT_EQ(codeOf(folder / "none.bspc"), vtkErrorCode::FileNotFoundError);
  EXPECT_EQ(codeOf(folder / "other.bspc"), vtkErrorCode::UnrecognizedFileTypeError);
  EXPECT_EQ(codeOf(folder / ""), vtkErrorCode::CannotOpenFileError);
  EXPECT_EQ(codeOf(""), vtkErrorCode::NoFileNameError);
}

/// Reads bytes that are no good; returns what is said about them.
std::string complaintAbout(const std::string& bytes, unsigned long* code = nullptr) {
  vtkNew<vtkBSPReader> reader;
  const ErrorLog log(reader);
  reader->ReadFromInputStringOn();
  reader->SetInputString(bytes);
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
  if (code != nullptr) *code = reader->GetErrorCode();
  return log.first();
}

TEST_F(Reader, DamagedBytesAreASentenceAndACode) {
  unsigned long code = 0;
  EXPECT_NE(complaintAbout("", &code).find("empty"), std::string::npos);
  EXPECT_EQ(code, vtkErrorCode::UnrecognizedFileTypeError);

  EXPECT_NE(complaintAbout(bytes_.substr(0, bytes_.size() / 2), &code).find("ends early"),
            std::string::npos);
  EXPECT_EQ(code, vtkErrorCode::PrematureEndOfFileError);

  std::string flipped = bytes_;
  flipped[bytes_.size() / 2] = static_cast<char>(flipped[bytes_.size() / 2] ^ 16);
  EXPECT_NE(complaintAbout(flipped, &code).find("checksum"), std::string::npos);
  EXPECT_EQ(code, vtkErrorCode::FileFormatError);

  std::string wrongMagic = bytes_;
  wrongMagic[1] = 'x';
  EXPECT_NE(complaintAbout(wrongMagic, &code).find("signature"), std::string::npos);
  EXPECT_EQ(code, vtkErrorCode::UnrecognizedFileTypeError);

  std::string newer = bytes_;
  newer[8] = 99;  // the byte behind the signature is the major version
  EXPECT_NE(complaintAbout(newer, &code).find("version 99"), std::string::npos);
  EXPECT_EQ(code, vtkErrorCode::FileFormatError);
}

TEST_F(Reader, EveryTruncationAndEveryFlippedByteOfAFileIsAnError) {
  const std::string small = written(pointsOnly(scannedSphere(5, 60, 255)));
  for (std::size_t size = 0; size < small.size(); ++size) {
    EXPECT_NE(complaintAbout(small.substr(0, size)), "") << size;
  }
  for (std::size_t i = 0; i < small.size(); ++i) {
    std::string flipped = small;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    EXPECT_NE(complaintAbout(flipped), "") << i;
  }
}

TEST_F(Reader, AfterAnErrorTheNextFileIsRead) {
  const ErrorLog log(reader_);
  reader_->ReadFromInputStringOn();
  reader_->SetInputString("nothing");
  reader_->Update();
  EXPECT_NE(reader_->GetErrorCode(), 0U);
  reader_->SetInputString(bytes_);
  reader_->Update();
  EXPECT_EQ(reader_->GetErrorCode(), 0U);
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 30000);
}

TEST_F(Reader, WhatTheFileSaysIsKnownWithoutDecoding) {
  // A byte of the last layer is wrong, which decoding would find.
  std::string damaged = bytes_;
  damaged[bytes_.size() - 200] = static_cast<char>(damaged[bytes_.size() - 200] ^ 1);
  reader_->ReadFromInputStringOn();
  reader_->SetInputString(damaged);
  reader_->UpdateInformation();
  EXPECT_EQ(reader_->GetErrorCode(), 0U);
  EXPECT_EQ(reader_->GetNumberOfPointsInFile(), 30000);
  EXPECT_GE(reader_->GetNumberOfTiles(), 30);
  EXPECT_EQ(reader_->GetNumberOfLevels(), 3);
  EXPECT_EQ(reader_->GetNumberOfPointsOfLevel(2), 30000);
  EXPECT_LT(reader_->GetNumberOfPointsOfLevel(0), reader_->GetNumberOfPointsOfLevel(1));
  EXPECT_EQ(reader_->GetNumberOfPointsOfLevel(3), 0);
  EXPECT_EQ(reader_->GetNumberOfPointArrays(), 0);
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 0);
  double bounds[6];
  input_->GetBounds(bounds);
  vtkInformation* info = reader_->GetOutputInformation(0);
  ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::BOUNDS()), 6);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(reader_->GetBoundsOfFile()[i], bounds[i]);
    EXPECT_EQ(info->Get(vtkStreamingDemandDrivenPipeline::BOUNDS())[i], bounds[i]);
  }
  const ErrorLog log(reader_);
  reader_->Update();
  EXPECT_NE(log.first().find("checksum"), std::string::npos);
}

TEST_F(Reader, LevelsAndBudgetsGiveFewerPointsThatStandForAll) {
  reader_->GeneratePointCountsOn();
  reader_->SetLevelOfDetail(1);
  vtkPolyData* output = readBytes(bytes_, reader_);
  EXPECT_EQ(output->GetNumberOfPoints(), reader_->GetNumberOfPointsOfLevel(1));
  auto* counts = vtkIdTypeArray::SafeDownCast(output->GetPointData()->GetArray("PointCount"));
  ASSERT_NE(counts, nullptr);
  vtkIdType sum = 0;
  for (vtkIdType i = 0; i < counts->GetNumberOfValues(); ++i) sum += counts->GetValue(i);
  EXPECT_EQ(sum, 30000);

  reader_->SetLevelOfDetail(-1);
  for (const vtkIdType most : {10, 2000, 12000, 29999}) {
    reader_->SetMaximumNumberOfPoints(most);
    reader_->Update();
    EXPECT_LE(output->GetNumberOfPoints(), most);
    EXPECT_GT(output->GetNumberOfPoints(), most / 200);
  }

  // Beyond the finest is the finest: files of a series differ in the number of their levels.
  reader_->SetMaximumNumberOfPoints(0);
  reader_->SetLevelOfDetail(3);
  reader_->Update();
  EXPECT_EQ(output->GetNumberOfPoints(), 30000);
}

TEST_F(Reader, ABoxGivesThePointsInside) {
  reader_->UseBoxOn();
  reader_->SetBox(1000, 2500, 0, 2000, 500.5, 4095);
  vtkPolyData* output = readBytes(bytes_, reader_);
  std::vector<std::array<double, 3>> inside;
  for (const auto& p : sortedPositions(input_)) {
    if (p[0] >= 1000 && p[0] <= 2500 && p[1] <= 2000 && p[2] >= 500.5) inside.push_back(p);
  }
  EXPECT_GT(inside.size(), 1000U);
  EXPECT_EQ(sortedPositions(output), inside);
}

TEST_F(Reader, CellIdsNameTheCellsOfALevel) {
  reader_->GenerateCellIdsOn();
  reader_->SetCellIdLevel(0);
  vtkPolyData* output = readBytes(bytes_, reader_);
  auto* cells = vtkIdTypeArray::SafeDownCast(output->GetPointData()->GetArray("CellId"));
  ASSERT_NE(cells, nullptr);
  ASSERT_EQ(cells->GetNumberOfTuples(), 30000);
  std::set<vtkIdType> ids;
  for (vtkIdType i = 0; i < 30000; ++i) ids.insert(cells->GetValue(i));
  EXPECT_EQ(static_cast<vtkIdType>(ids.size()), reader_->GetNumberOfPointsOfLevel(0));
  EXPECT_EQ(*ids.begin(), 0);
  EXPECT_EQ(*ids.rbegin() + 1, static_cast<vtkIdType>(ids.size()));
}

TEST_F(Reader, CellIdsAreOfTheLevelThatIsReadIfThatIsCoarser) {
  reader_->GenerateCellIdsOn();
  reader_->SetLevelOfDetail(0);
  reader_->SetCellIdLevel(2);
  vtkPolyData* output = readBytes(bytes_, reader_);
  auto* cells = vtkIdTypeArray::SafeDownCast(output->GetPointData()->GetArray("CellId"));
  ASSERT_NE(cells, nullptr);
  std::set<vtkIdType> ids;
  for (vtkIdType i = 0; i < cells->GetNumberOfTuples(); ++i) ids.insert(cells->GetValue(i));
  EXPECT_EQ(static_cast<vtkIdType>(ids.size()), reader_->GetNumberOfPointsOfLevel(0));
}

TEST_F(Reader, PiecesAreTheWholeWithoutOverlap) {
  for (const vtkIdType most : {0, 30}) {
    reader_->SetMaximumNumberOfPoints(most);
    readBytes(bytes_, reader_);
    const auto whole = sortedPositions(reader_->GetOutput());
    for (const int pieces : {1, 2, 7, 100}) {
      std::vector<std::array<double, 3>> all;
      vtkIdType largest = 0;
      for (int piece = 0; piece < pieces; ++piece) {
        reader_->UpdatePiece(piece, pieces, 0);
        const auto part = sortedPositions(reader_->GetOutput());
        largest = std::max(largest, reader_->GetOutput()->GetNumberOfPoints());
        all.insert(all.end(), part.begin(), part.end());
      }
      std::sort(all.begin(), all.end());
      if (most == 0) {
        EXPECT_EQ(all, whole) << pieces << " pieces";
        EXPECT_LE(largest, 30000 / pieces + 2000);
      } else {
        // Thinned pieces take other points than a thinned whole, but as many.
        EXPECT_LE(static_cast<vtkIdType>(all.size()), most);
        EXPECT_GE(static_cast<vtkIdType>(all.size()), most - pieces);
      }
    }
  }
}

TEST_F(Reader, WhatIsWholeOfATruncatedFileIsGivenOnRequest) {
  const std::string cut = bytes_.substr(0, bytes_.size() - 1000);
  reader_->AllowPartialOn();
  vtkPolyData* output = readBytes(cut, reader_);
  EXPECT_EQ(output->GetNumberOfPoints(), reader_->GetNumberOfPointsOfLevel(1));
}

TEST_F(Reader, ProgressRisesAndAbortGivesAnEmptyOutput) {
  struct Watch {
    void call() {
      EXPECT_GE(reader->GetProgress(), last);
      last = reader->GetProgress();
      ++calls;
      if (last >= stopAt) reader->SetAbortExecute(1);
    }
    vtkBSPReader* reader;
    double stopAt;
    double last = 0;
    int calls = 0;
  };
  readBytes(bytes_, reader_);
  reader_->Modified();
  Watch watch{reader_, 2};
  const unsigned long tag = reader_->AddObserver(vtkCommand::ProgressEvent, &watch, &Watch::call);
  reader_->Update();
  EXPECT_GT(watch.calls, 3);
  EXPECT_EQ(watch.last, 1);
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 30000);
  reader_->RemoveObserver(tag);

  Watch stopping{reader_, 0.3};
  const ErrorLog log(reader_);
  const unsigned long stop =
      reader_->AddObserver(vtkCommand::ProgressEvent, &stopping, &Watch::call);
  reader_->Modified();
  reader_->Update();
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(reader_->GetErrorCode(), 0U);
  EXPECT_EQ(log.first(), "");
  reader_->RemoveObserver(stop);

  reader_->SetAbortExecute(0);
  reader_->Modified();
  reader_->Update();
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 30000);
}

TEST_F(Reader, CoordinatesAreAsWideAsTheyNeedToBe) {
  const auto typeOf = [this](const std::vector<std::array<double, 3>>& points, int type) {
    const auto input = pointsOnly(points, type);
    vtkPolyData* output = readBytes(written(input), reader_);
    EXPECT_EQ(sortedPositions(output), sortedPositions(input));
    return output->GetPoints()->GetDataType();
  };
  const std::array<double, 3> utm = {500123.4567, 5427188.4612, 101.4901};
  EXPECT_EQ(typeOf({utm, {500124.4567, 5427189.1234, 99.75}}, VTK_DOUBLE), VTK_DOUBLE);
  EXPECT_EQ(typeOf({{0.5, 0.25, 0}, {1, 2, 3}}, VTK_FLOAT), VTK_FLOAT);
  EXPECT_EQ(typeOf({{0, 0, 0}, {1, 2, 16777216}}, VTK_INT), VTK_FLOAT);
  EXPECT_EQ(typeOf({{0, 0, 0}, {1, 2, 16777217}}, VTK_INT), VTK_DOUBLE);
  EXPECT_EQ(typeOf({{0, 0, 0}, {1, 200, 3}}, VTK_UNSIGNED_CHAR), VTK_FLOAT);
}

TEST_F(Reader, MoreThanTheMemoryLimitIsAnError) {
  const std::string bytes = written(pointsOnly(std::vector<GridPoint>(300000, GridPoint{1, 2, 3})));
  reader_->SetMemoryLimit(1);
  const ErrorLog log(reader_);
  reader_->ReadFromInputStringOn();
  reader_->SetInputString(bytes);
  reader_->Update();
  EXPECT_NE(log.first().find("limit of 1 MiB"), std::string::npos) << log.first();
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 0);
  reader_->SetMemoryLimit(0);
  reader_->Update();
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 300000);
}

/// The file claims 2^28 equal points, which take six bytes in it.
TEST_F(Reader, WhatTheLimitHasNoRoomForIsNotDecoded) {
  reader_->SetMemoryLimit(1);
  const ErrorLog log(reader_);
  reader_->SetFileName(BSPC_TEST_DATA "/fuzz/vtk_reader/points_beyond_the_memory_limit");
  reader_->Update();
  EXPECT_NE(log.first().find("more memory than the limit"), std::string::npos) << log.first();
  EXPECT_EQ(reader_->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(Reader, TheOutputIsMadeAnewOnlyWhenSomethingChanged) {
  readBytes(bytes_, reader_);
  const vtkMTimeType time = reader_->GetOutput()->GetMTime();
  reader_->Update();
  EXPECT_EQ(reader_->GetOutput()->GetMTime(), time);
  reader_->SetLevelOfDetail(0);
  reader_->Update();
  EXPECT_GT(reader_->GetOutput()->GetMTime(), time);
}

}  // namespace
}  // namespace bspc::test
