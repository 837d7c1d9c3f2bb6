// Arrays and field data through the writer and the reader: every type, what VTK knows of them, and
// which of them are written and read.

#include <gtest/gtest.h>
#include <vtkBitArray.h>
#include <vtkCommand.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkUnsignedLongArray.h>
#include <vtkVariantArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "support/point_sets.h"
#include "vtkBSPReader.h"
#include "vtkBSPWriter.h"
#include "vtkErrorCode.h"
#include "vtk_support/vtk_test_support.h"

namespace bspc::test {
namespace {

constexpr vtkIdType kPoints = 4000;

template <class Array>
vtkSmartPointer<Array> newArray(const char* name, int components = 1) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(kPoints);
  return array;
}

/// Values of any type, as text that tells all of them apart.
std::string tuple(vtkAbstractArray* array, vtkIdType i) {
  std::string text;
  for (int k = 0; k < array->GetNumberOfComponents(); ++k) {
    const vtkIdType value = i * array->GetNumberOfComponents() + k;
    if (auto* strings = vtkStringArray::SafeDownCast(array)) {
      text += strings->GetValue(value) + '\n';
    } else if (auto* bits = vtkBitArray::SafeDownCast(array)) {
      text += bits->GetValue(value) != 0 ? '1' : '0';
    } else {
      const auto size = static_cast<std::size_t>(array->GetDataTypeSize());
      const char* bytes = static_cast<const char*>(array->GetVoidPointer(value));
      text.append(bytes, size);
    }
  }
  return text;
}

/// A scanned terrain in UTM coordinates with what scanners record, and an array "Row" that says
/// which point of the input it was.
class Arrays : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<std::array<double, 3>> points;
    for (const GridPoint& p : scannedSphere(9, kPoints, 4095)) {
      points.push_back({500000 + p[0] * 0.01, 5400000 + p[1] * 0.01, 100 + p[2] * 0.01});
    }
    input_ = pointsOnly(points, VTK_DOUBLE);
    auto rows = newArray<vtkUnsignedIntArray>("Row");
    for (vtkIdType i = 0; i < kPoints; ++i) rows->SetValue(i, static_cast<unsigned>(i));
    add(rows);
  }

  void add(vtkAbstractArray* array) { input_->GetPointData()->AddArray(array); }

  void addScan() {
    auto colours = newArray<vtkUnsignedCharArray>("RGB", 3);
    auto normals = newArray<vtkFloatArray>("Normals", 3);
    auto classes = newArray<vtkIntArray>("Classification");
    auto times = newArray<vtkLongLongArray>("GpsTime");
    auto labels = newArray<vtkStringArray>("Label");
    for (vtkIdType i = 0; i < kPoints; ++i) {
      double n[3];
      input_->GetPoint(i, n);
      for (int k = 0; k < 3; ++k) n[k] -= k == 0 ? 500020 : k == 1 ? 5400020 : 120;
      vtkMath::Normalize(n);
      normals->SetTuple(i, n);
      for (int k = 0; k < 3; ++k) {
        colours->SetComponent(i, k, std::floor(128 + 100 * n[k]) + static_cast<double>(i % 5));
      }
      classes->SetValue(i, static_cast<int>(random_() % 7) - 1);
      times->SetValue(i, 1234567890123456LL + i * 997 + static_cast<long long>(random_() % 90));
      labels->SetValue(i, i % 3 == 0 ? "ground" : i % 3 == 1 ? "Bäume" : "");
    }
    input_->GetPointData()->SetScalars(colours);
    input_->GetPointData()->SetNormals(normals);
    for (vtkAbstractArray* array :
         {static_cast<vtkAbstractArray*>(classes), static_cast<vtkAbstractArray*>(times),
          static_cast<vtkAbstractArray*>(labels)}) {
      add(array);
    }
  }

  vtkPolyData* roundTrip() { return readBytes(written(input_, writer_), reader_); }

  /// Expects that a point data array came back with every value at the point that it belongs to.
  void expectSame(vtkPolyData* output, const std::string& name) {
    vtkAbstractArray* before = input_->GetPointData()->GetAbstractArray(name.c_str());
    vtkAbstractArray* after = output->GetPointData()->GetAbstractArray(name.c_str());
    vtkDataArray* rows = output->GetPointData()->GetArray("Row");
    ASSERT_NE(after, nullptr) << name;
    ASSERT_NE(rows, nullptr);
    ASSERT_EQ(after->GetNumberOfTuples(), kPoints) << name;
    ASSERT_EQ(after->GetNumberOfComponents(), before->GetNumberOfComponents()) << name;
    ASSERT_EQ(after->GetDataTypeSize(), before->GetDataTypeSize()) << name;
    for (vtkIdType i = 0; i < kPoints; ++i) {
      const auto row = static_cast<vtkIdType>(rows->GetComponent(i, 0));
      ASSERT_EQ(tuple(after, i), tuple(before, row)) << name << ", point " << i;
    }
  }

  vtkSmartPointer<vtkPolyData> input_;
  vtkNew<vtkBSPWriter> writer_;
  vtkNew<vtkBSPReader> reader_;
  std::mt19937_64 random_{2006};
};

TEST_F(Arrays, AScanComesBackElementByElement) {
  addScan();
  vtkPolyData* output = roundTrip();
  ASSERT_EQ(output->GetNumberOfPoints(), kPoints);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  vtkDataArray* rows = output->GetPointData()->GetArray("Row");
  ASSERT_NE(rows, nullptr);
  for (vtkIdType i = 0; i < kPoints; ++i) {
    double after[3];
    double before[3];
    output->GetPoint(i, after);
    input_->GetPoint(static_cast<vtkIdType>(rows->GetComponent(i, 0)), before);
    for (int k = 0; k < 3; ++k) ASSERT_EQ(after[k], before[k]);
  }
  for (const char* name : {"RGB", "Normals", "Classification", "GpsTime", "Label"}) {
    expectSame(output, name);
  }
  EXPECT_STREQ(output->GetPointData()->GetScalars()->GetName(), "RGB");
  EXPECT_STREQ(output->GetPointData()->GetNormals()->GetName(), "Normals");
  EXPECT_EQ(output->GetPointData()->GetTCoords(), nullptr);
  EXPECT_NE(vtkUnsignedCharArray::SafeDownCast(output->GetPointData()->GetScalars()), nullptr);
}

TEST_F(Arrays, EveryTypeOfVtkComesBackBitForBit) {
  const std::vector<int> types = {
      VTK_FLOAT,   VTK_DOUBLE,        VTK_CHAR,      VTK_SIGNED_CHAR,
      VTK_INT,     VTK_UNSIGNED_CHAR, VTK_SHORT,     VTK_UNSIGNED_SHORT,
      VTK_LONG,    VTK_UNSIGNED_INT,  VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG,
      VTK_ID_TYPE, VTK_UNSIGNED_LONG, VTK_BIT};
  for (const int type : types) {
    auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    array->SetName(array->GetClassName());
    array->SetNumberOfComponents(2);
    array->SetNumberOfTuples(kPoints);
    auto* bytes = static_cast<unsigned char*>(array->GetVoidPointer(0));
    const vtkIdType size = type == VTK_BIT ? kPoints / 4 : 2 * kPoints * array->GetDataTypeSize();
    // Any bits: extremes, infinities and NaN among them.
    for (vtkIdType i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(random_());
    add(array);
  }
  vtkPolyData* output = roundTrip();
  for (int i = 0; i < input_->GetPointData()->GetNumberOfArrays(); ++i) {
    expectSame(output, input_->GetPointData()->GetArrayName(i));
  }
}

TEST_F(Arrays, NamesOfComponentsAndUnitsComeBack) {
  auto wind = newArray<vtkFloatArray>("Wind", 2);
  wind->FillValue(3);
  wind->SetComponentName(0, "east");
  wind->SetComponentName(1, "north");
  wind->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), "m/s");
  add(wind);
  vtkDataArray* back = roundTrip()->GetPointData()->GetArray("Wind");
  ASSERT_NE(back, nullptr);
  EXPECT_STREQ(back->GetComponentName(0), "east");
  EXPECT_STREQ(back->GetComponentName(1), "north");
  EXPECT_STREQ(back->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), "m/s");
}

TEST_F(Arrays, ActiveArraysAreActiveAgain) {
  vtkPointData* data = input_->GetPointData();
  auto height = newArray<vtkDoubleArray>("Height");
  auto coordinates = newArray<vtkFloatArray>("UV", 2);
  auto ids = newArray<vtkIdTypeArray>("Ids");
  auto pedigree = newArray<vtkStringArray>("Origin");
  for (vtkIdType i = 0; i < kPoints; ++i) {
    height->SetValue(i, static_cast<double>(i));
    coordinates->SetTuple2(i, static_cast<double>(i), 1);
    ids->SetValue(i, i);
    pedigree->SetValue(i, "p" + std::to_string(i));
  }
  data->SetScalars(height);
  data->SetTCoords(coordinates);
  data->SetGlobalIds(ids);
  data->SetPedigreeIds(pedigree);
  vtkPointData* back = roundTrip()->GetPointData();
  ASSERT_NE(back->GetScalars(), nullptr);
  EXPECT_STREQ(back->GetScalars()->GetName(), "Height");
  ASSERT_NE(back->GetTCoords(), nullptr);
  EXPECT_STREQ(back->GetTCoords()->GetName(), "UV");
  ASSERT_NE(back->GetGlobalIds(), nullptr);
  EXPECT_STREQ(back->GetGlobalIds()->GetName(), "Ids");
  ASSERT_NE(back->GetPedigreeIds(), nullptr);
  EXPECT_STREQ(back->GetPedigreeIds()->GetName(), "Origin");
}

TEST_F(Arrays, KeptOrderIsTheOrderOfTheInput) {
  addScan();
  writer_->KeepOrderOn();
  writer_->SetPointsPerTile(1000);
  vtkPolyData* output = roundTrip();
  vtkDataArray* rows = output->GetPointData()->GetArray("Row");
  for (vtkIdType i = 0; i < kPoints; ++i) ASSERT_EQ(rows->GetComponent(i, 0), i);
  expectSame(output, "Label");
}

TEST_F(Arrays, OriginalIdsTellWhichPointEachOneWas) {
  addScan();
  writer_->StoreOriginalPointIdsOn();
  vtkPointData* output = roundTrip()->GetPointData();
  vtkDataArray* rows = output->GetArray("Row");
  vtkDataArray* ids = output->GetArray("OriginalPointIds");
  ASSERT_NE(ids, nullptr);
  bool moved = false;
  for (vtkIdType i = 0; i < kPoints; ++i) {
    ASSERT_EQ(rows->GetComponent(i, 0), ids->GetComponent(i, 0));
    moved = moved || ids->GetComponent(i, 0) != static_cast<double>(i);
  }
  EXPECT_TRUE(moved);
}

TEST_F(Arrays, TheReaderReadsTheChosenOnes) {
  addScan();
  const std::string bytes = written(input_, writer_);
  reader_->ReadFromInputStringOn();
  reader_->SetInputString(bytes);
  reader_->SetPointArrayStatus("Label", 0);
  reader_->UpdateInformation();
  ASSERT_EQ(reader_->GetNumberOfPointArrays(), 6);
  EXPECT_STREQ(reader_->GetPointArrayName(0), "Row");
  EXPECT_EQ(reader_->GetPointArrayStatus("Label"), 0);
  EXPECT_EQ(reader_->GetPointArrayStatus("RGB"), 1);
  reader_->Update();
  vtkPointData* data = reader_->GetOutput()->GetPointData();
  EXPECT_EQ(data->GetNumberOfArrays(), 5);
  EXPECT_FALSE(data->HasArray("Label"));
  // A change of the selection alone makes the output anew.
  reader_->GetPointDataArraySelection()->DisableAllArrays();
  reader_->SetPointArrayStatus("RGB", 1);
  reader_->Update();
  EXPECT_EQ(data->GetNumberOfArrays(), 1);
  EXPECT_TRUE(data->HasArray("RGB"));
  EXPECT_NE(data->GetScalars(), nullptr);
}

TEST_F(Arrays, TheWriterLeavesOutWhatIsSwitchedOff) {
  vtkNew<vtkVariantArray> variants;
  variants->SetName("Anything");
  variants->SetNumberOfTuples(kPoints);
  add(variants);
  {
    const ErrorLog log(writer_);
    writer_->SetInputData(input_);
    writer_->WriteToOutputStringOn();
    EXPECT_EQ(writer_->Write(), 0);
    EXPECT_NE(log.first().find("\"Anything\""), std::string::npos) << log.first();
    EXPECT_EQ(writer_->GetErrorCode(), vtkErrorCode::FileFormatError);
    writer_->RemoveObservers(vtkCommand::ErrorEvent);
  }
  writer_->SetPointArrayStatus("Anything", 0);
  vtkPolyData* output = roundTrip();
  EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 1);
  expectSame(output, "Row");
}

TEST_F(Arrays, TolerancesBoundTheError) {
  addScan();
  writer_->SetArrayTolerance("Normals", 0.5);
  vtkPolyData* output = roundTrip();
  vtkDataArray* rows = output->GetPointData()->GetArray("Row");
  double worst = 0;
  for (vtkIdType i = 0; i < kPoints; ++i) {
    double after[3];
    double before[3];
    output->GetPointData()->GetNormals()->GetTuple(i, after);
    input_->GetPointData()->GetNormals()->GetTuple(static_cast<vtkIdType>(rows->GetComponent(i, 0)),
                                                   before);
    worst = std::max(worst, vtkMath::AngleBetweenVectors(after, before));
  }
  EXPECT_LE(vtkMath::DegreesFromRadians(worst), 0.5001);
  EXPECT_LE(vtkMath::DegreesFromRadians(worst), writer_->GetMaximumArrayError("Normals") + 1e-4);
  EXPECT_EQ(writer_->GetMaximumArrayError("RGB"), 0);
  expectSame(output, "RGB");
}

TEST_F(Arrays, ArraysOfAnotherLengthAreRefused) {
  vtkNew<vtkFloatArray> wrong;
  wrong->SetName("TooShort");
  wrong->SetNumberOfTuples(kPoints - 1);
  add(wrong);
  const ErrorLog log(writer_);
  writer_->SetInputData(input_);
  writer_->WriteToOutputStringOn();
  EXPECT_EQ(writer_->Write(), 0);
  EXPECT_NE(log.first().find("\"TooShort\""), std::string::npos) << log.first();
}

TEST_F(Arrays, ValuesThatDoNotLieSideBySideAreTaken) {
  auto apart = vtkSmartPointer<vtkSOADataArrayTemplate<float>>::New();
  apart->SetName("Apart");
  apart->SetNumberOfComponents(2);
  apart->SetNumberOfTuples(kPoints);
  auto beside = newArray<vtkFloatArray>("Beside", 2);
  for (vtkIdType i = 0; i < kPoints; ++i) {
    apart->SetTuple2(i, std::sqrt(static_cast<double>(i)), 0.1);
    beside->SetTuple2(i, std::sqrt(static_cast<double>(i)), 0.1);
  }
  add(apart);
  vtkPolyData* output = roundTrip();
  ASSERT_TRUE(output->GetPointData()->HasArray("Apart"));
  input_->GetPointData()->RemoveArray("Apart");
  beside->SetName("Apart");
  add(beside);
  expectSame(output, "Apart");
}

TEST_F(Arrays, GhostsGoWithTheirValues) {
  addScan();
  auto ghosts = newArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < kPoints; ++i) {
    ghosts->SetValue(i, i % 4 == 0 ? vtkDataSetAttributes::DUPLICATEPOINT : 0);
  }
  add(ghosts);
  vtkPolyData* output = roundTrip();
  ASSERT_EQ(output->GetNumberOfPoints(), kPoints / 4 * 3);
  vtkPointData* data = output->GetPointData();
  EXPECT_STREQ(data->GetScalars()->GetName(), "RGB");
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i) {
    const auto row = static_cast<vtkIdType>(data->GetArray("Row")->GetComponent(i, 0));
    ASSERT_NE(row % 4, 0);
    for (const char* name : {"RGB", "GpsTime", "Label"}) {
      ASSERT_EQ(tuple(data->GetAbstractArray(name), i),
                tuple(input_->GetPointData()->GetAbstractArray(name), row));
    }
  }
}

TEST_F(Arrays, PiecesHaveThemToo) {
  addScan();
  writer_->SetPointsPerTile(500);
  readBytes(written(input_, writer_), reader_);
  for (const int pieces : {2, 7, 50}) {
    std::vector<int> seen(kPoints);
    for (int piece = 0; piece < pieces; ++piece) {
      reader_->UpdatePiece(piece, pieces, 0);
      vtkPointData* data = reader_->GetOutput()->GetPointData();
      // All pieces have the same arrays, those without points as well.
      ASSERT_EQ(data->GetNumberOfArrays(), 6);
      for (vtkIdType i = 0; i < reader_->GetOutput()->GetNumberOfPoints(); ++i) {
        const auto row = static_cast<vtkIdType>(data->GetArray("Row")->GetComponent(i, 0));
        ++seen[static_cast<std::size_t>(row)];
        ASSERT_EQ(tuple(data->GetScalars(), i), tuple(input_->GetPointData()->GetScalars(), row));
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), kPoints);
  }
}

TEST_F(Arrays, ColumnsOfATableAreArrays) {
  addScan();
  vtkNew<vtkTable> table;
  for (int k = 0; k < 3; ++k) {
    auto column = newArray<vtkDoubleArray>(k == 0 ? "X" : k == 1 ? "Y" : "Z");
    column->CopyComponent(0, input_->GetPoints()->GetData(), k);
    table->AddColumn(column);
  }
  for (int i = 0; i < input_->GetPointData()->GetNumberOfArrays(); ++i) {
    table->AddColumn(input_->GetPointData()->GetAbstractArray(i));
  }
  vtkPolyData* output = readBytes(written(table, writer_), reader_);
  EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 6);
  EXPECT_EQ(sortedPositions(output), sortedPositions(input_));
  for (const char* name : {"RGB", "Label", "GpsTime"}) expectSame(output, name);
}

TEST_F(Arrays, FieldDataComesBack) {
  const auto text = [](const char* name, const char* value) {
    auto array = vtkSmartPointer<vtkStringArray>::New();
    array->SetName(name);
    array->InsertNextValue(value);
    return array;
  };
  vtkFieldData* before = input_->GetFieldData();
  before->AddArray(text("CRS", "EPSG:25832"));
  before->AddArray(text("LengthUnit", "m"));
  before->AddArray(text("Operator", "Grün & Söhne"));
  auto names = text("Stations", "first");
  names->InsertNextValue("second");
  before->AddArray(names);
  vtkNew<vtkDoubleArray> matrix;
  matrix->SetName("ToWorld");
  matrix->SetNumberOfComponents(4);
  for (int i = 0; i < 16; ++i) matrix->InsertNextValue(i / 3.0);
  before->AddArray(matrix);

  vtkFieldData* after = roundTrip()->GetFieldData();
  ASSERT_EQ(after->GetNumberOfArrays(), before->GetNumberOfArrays());
  for (int i = 0; i < before->GetNumberOfArrays(); ++i) {
    vtkAbstractArray* expected = before->GetAbstractArray(i);
    vtkAbstractArray* array = after->GetAbstractArray(expected->GetName());
    ASSERT_NE(array, nullptr) << expected->GetName();
    ASSERT_EQ(array->GetNumberOfTuples(), expected->GetNumberOfTuples());
    for (vtkIdType j = 0; j < expected->GetNumberOfTuples(); ++j) {
      EXPECT_EQ(tuple(array, j), tuple(expected, j)) << expected->GetName();
    }
  }
}

TEST_F(Arrays, AnArrayThatIsMadeDoesNotReplaceOneOfTheFile) {
  auto ids = newArray<vtkFloatArray>("CellId");
  ids->FillValue(5);
  add(ids);
  const std::string bytes = written(input_, writer_);
  const ErrorLog log(reader_);
  reader_->ReadFromInputStringOn();
  reader_->SetInputString(bytes);
  reader_->GenerateCellIdsOn();
  reader_->Update();
  EXPECT_NE(log.first().find("\"CellId\""), std::string::npos) << log.first();
  reader_->SetPointArrayStatus("CellId", 0);
  reader_->Update();
  EXPECT_EQ(reader_->GetErrorCode(), 0U);
}

}  // namespace
}  // namespace bspc::test
