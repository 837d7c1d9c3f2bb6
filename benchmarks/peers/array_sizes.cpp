// Sizes of point arrays in .bspc, in VTK's .vtp with LZMA, and in Draco, in one table.
// Run: array_sizes [FILE.vtp or FILE.bspc]; without a file a scan is made.
//
// The size of an array is that of a file with positions and this array less that of one with the
// positions alone, in bits a value. Every coder must give all values back, or it has no size: what
// was read is compared with what was written, as multisets of the tuples of positions and array.
// .vtp is written raw and appended, in blocks of 4 MiB. Draco gets whole coordinates; its kd-tree
// and its coding one after the other are both tried at the greatest effort, and the smaller result
// counts.

#include <vtkBSPReader.h>
#include <vtkBSPWriter.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "draco_array_size.h"

namespace bspc {
namespace {

using PolyData = vtkSmartPointer<vtkPolyData>;

template <class Array>
vtkSmartPointer<Array> addArray(vtkPolyData* data, const char* name, int components) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(array);
  return array;
}

/// A bumpy sphere in UTM coordinates, scanned line by line, with what scanners record.
PolyData madeScan() {
  constexpr int kLines = 300;
  constexpr double kPi = 3.14159265358979323846;
  auto data = PolyData::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<std::array<double, 3>> directions;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  for (int i = 0; i < kLines * kLines; ++i) {
    const double theta = kPi * (i / kLines + 0.5) / kLines;
    const double phi = 2 * kPi * (i % kLines) / kLines;
    const std::array<double, 3> d = {std::sin(theta) * std::cos(phi),
                                     std::sin(theta) * std::sin(phi), std::cos(theta)};
    const double radius = 30 + std::sin(5 * theta) * std::cos(3 * phi) + 0.003 * noise(random);
    const auto millimetres = [&](double origin, std::size_t k) {
      return std::round(1000 * (origin + radius * d[k])) / 1000;
    };
    points->InsertNextPoint(millimetres(500000, 0), millimetres(5400000, 1), millimetres(100, 2));
    directions.push_back(d);
  }
  data->SetPoints(points);
  auto colours = addArray<vtkUnsignedCharArray>(data, "RGB", 3);
  auto normals = addArray<vtkFloatArray>(data, "Normals", 3);
  auto classes = addArray<vtkIntArray>(data, "Classification", 1);
  auto times = addArray<vtkLongLongArray>(data, "GpsTime", 1);
  auto curvature = addArray<vtkDoubleArray>(data, "Curvature", 1);
  auto labels = addArray<vtkStringArray>(data, "Label", 1);
  long long time = 1234567890123456LL;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto id = static_cast<vtkIdType>(i);
    const std::array<double, 3>& d = directions[i];
    std::array<double, 3> normal = d;
    for (double& n : normal) n += 0.01 * noise(random);
    vtkMath::Normalize(normal.data());
    normals->SetTuple(id, normal.data());
    for (std::size_t k = 0; k < 3; ++k) {
      colours->SetComponent(id, static_cast<int>(k),
                            std::floor(128 + 90 * std::sin(4 * d[k]) + 2 * noise(random)));
    }
    const int kind = d[2] > 0.3 ? 6 : d[2] > -0.2 ? 5 : 2;
    classes->SetValue(id, kind);
    labels->SetValue(id, kind == 6 ? "building" : kind == 5 ? "vegetation" : "ground");
    curvature->SetValue(id, std::sin(4 * d[0]) * std::cos(5 * d[1]) + 0.001 * noise(random));
    time += 900 + static_cast<long long>(random() % 200);
    times->SetValue(id, time);
  }
  return data;
}

PolyData readFile(const std::string& path) {
  vtkSmartPointer<vtkAlgorithm> reader;
  if (vtkBSPReader::CanReadFile(path.c_str()) != 0) {
    auto bspcReader = vtkSmartPointer<vtkBSPReader>::New();
    bspcReader->SetFileName(path.c_str());
    reader = bspcReader;
  } else {
    auto xmlReader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
    xmlReader->SetFileName(path.c_str());
    reader = xmlReader;
  }
  reader->Update();
  PolyData data = vtkPolyData::SafeDownCast(reader->GetOutputDataObject(0));
  if (reader->GetErrorCode() != 0 || data == nullptr || data->GetNumberOfPoints() == 0) {
    throw std::runtime_error(path + " has no points that can be read");
  }
  return data;
}

/// The points with that array alone, or without any if it is null.
PolyData only(vtkPolyData* data, vtkAbstractArray* array) {
  auto part = PolyData::New();
  part->SetPoints(data->GetPoints());
  if (array != nullptr) part->GetPointData()->AddArray(array);
  return part;
}

void appendTuple(std::string& text, vtkAbstractArray* array, vtkIdType i) {
  if (auto* strings = vtkStringArray::SafeDownCast(array)) {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k) {
      text += strings->GetValue(i * array->GetNumberOfComponents() + k) + '\n';
    }
    return;
  }
  const auto size = static_cast<std::size_t>(array->GetDataTypeSize()) *
                    static_cast<std::size_t>(array->GetNumberOfComponents());
  text.append(static_cast<const char*>(array->GetVoidPointer(0)) + size * i, size);
}

/// Tuples of positions and of all arrays, in ascending order.
std::vector<std::string> sortedTuples(vtkPolyData* data) {
  std::vector<std::string> tuples(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < tuples.size(); ++i) {
    const auto id = static_cast<vtkIdType>(i);
    appendTuple(tuples[i], data->GetPoints()->GetData(), id);
    for (int a = 0; a < data->GetPointData()->GetNumberOfArrays(); ++a) {
      appendTuple(tuples[i], data->GetPointData()->GetAbstractArray(a), id);
    }
  }
  std::sort(tuples.begin(), tuples.end());
  return tuples;
}

using Size = std::optional<std::size_t>;

/// Effort 0 is the default.
Size bspcSize(vtkPolyData* data, int effort, bool keepOrder) {
  vtkNew<vtkBSPWriter> writer;
  writer->SetEffort(effort);
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  writer->SetKeepOrder(keepOrder);
  if (writer->Write() == 0) return std::nullopt;
  vtkNew<vtkBSPReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  const bool same = sortedTuples(reader->GetOutput()) == sortedTuples(data);
  return same ? Size(writer->GetOutputString().size()) : std::nullopt;
}

Size vtpSize(vtkPolyData* data) {
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  writer->SetCompressorTypeToLZMA();
  writer->SetCompressionLevel(9);
  writer->SetBlockSize(1 << 22);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  if (writer->Write() == 0) return std::nullopt;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  const bool same = sortedTuples(reader->GetOutput()) == sortedTuples(data);
  return same ? Size(writer->GetOutputString().size()) : std::nullopt;
}

using SizeOf = std::function<Size(vtkPolyData* data)>;

/// Bytes that the first array of the data adds to a file; without arrays, the file.
Size added(const SizeOf& sizeOf, vtkPolyData* data) {
  const Size with = sizeOf(data);
  if (data->GetPointData()->GetNumberOfArrays() == 0 || !with) return with;
  const Size without = sizeOf(only(data, nullptr));
  return without ? Size(*with - std::min(*with, *without)) : std::nullopt;
}

Size dracoAdded(vtkPolyData* data) {
  Size least;
  for (const bool kdTree : {false, true}) {
    const Size size = added(
        [kdTree](vtkPolyData* d) {
          return dracoSize(d, d->GetPointData()->GetAbstractArray(0), kdTree);
        },
        data);
    if (size && (!least || *size < *least)) least = size;
  }
  return least;
}

std::string bits(const Size& bytes, std::int64_t values) {
  if (!bytes) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f",
                8 * static_cast<double>(*bytes) / static_cast<double>(values));
  return text.data();
}

/// One line of the table, of the first array of the data or of its positions.
void printLine(vtkPolyData* data) {
  vtkAbstractArray* array = data->GetPointData()->GetAbstractArray(0);
  const std::string name = array != nullptr ? array->GetName() : "(positions)";
  if (array == nullptr) array = data->GetPoints()->GetData();
  const std::int64_t values = array->GetNumberOfValues();
  const std::string type = std::string(array->GetDataTypeAsString()) + " x " +
                           std::to_string(array->GetNumberOfComponents());
  const bool text = vtkStringArray::SafeDownCast(array) != nullptr;
  const std::string raw = text ? "-" : std::to_string(8 * array->GetDataTypeSize());
  constexpr int kMostEffort = 9;
  const auto byDefault = [](vtkPolyData* d) { return bspcSize(d, 0, false); };
  const auto smallest = [](vtkPolyData* d) { return bspcSize(d, kMostEffort, false); };
  const auto inGivenOrder = [](vtkPolyData* d) { return bspcSize(d, kMostEffort, true); };
  std::printf("%-17s %-18s %6s %9s %9s %9s %9s %9s\n", name.c_str(), type.c_str(), raw.c_str(),
              bits(added(vtpSize, data), values).c_str(), bits(dracoAdded(data), values).c_str(),
              bits(added(byDefault, data), values).c_str(),
              bits(added(smallest, data), values).c_str(),
              bits(added(inGivenOrder, data), values).c_str());
  std::fflush(stdout);
}

int runAll(int count, char** arguments) {
  if (count > 2) {
    std::fputs("Usage: array_sizes [FILE.vtp or FILE.bspc]\n", stderr);
    return 2;
  }
  const PolyData data = count == 2 ? readFile(arguments[1]) : madeScan();
  std::printf("%s, %lld points; bits a value\n\n", count == 2 ? arguments[1] : "a made scan",
              static_cast<long long>(data->GetNumberOfPoints()));
  std::printf("%-17s %-18s %6s %9s %9s %9s %9s %9s\n", "array", "type", "raw", "vtp LZMA", "Draco",
              ".bspc", "effort 9", "in order");
  printLine(only(data, nullptr));
  for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i) {
    printLine(only(data, data->GetPointData()->GetAbstractArray(i)));
  }
  std::puts(
      "\n-: the coder does not give all values back. .bspc: by default, and at effort 9, and so "
      "with\n"
      "the order of the input kept, as .vtp does; what that costs is in the line of the "
      "positions.");
  return 0;
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  try {
    return bspc::runAll(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "array_sizes: %s\n", error.what());
    return 1;
  }
}
