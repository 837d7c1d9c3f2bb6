#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "codec.h"

namespace bspc::bench {

namespace {

struct VtpSettings {
  int compressor = vtkXMLWriter::ZLIB;
  int level = 5;              ///< VTK's default
  std::size_t block = 32768;  ///< likewise, in bytes
};

void setPoints(vtkPolyData* data, const Coordinates& xyz) {
  constexpr std::int32_t kWholeInSingle = 1 << 24;
  const bool single = std::all_of(xyz.begin(), xyz.end(),
                                  [](std::int32_t c) { return std::abs(c) <= kWholeInSingle; });
  vtkNew<vtkPoints> points;
  points->SetDataType(single ? VTK_FLOAT : VTK_DOUBLE);
  points->SetNumberOfPoints(static_cast<vtkIdType>(xyz.size() / 3));
  const auto copy = [&xyz](auto* to) { std::copy(xyz.begin(), xyz.end(), to); };
  if (single) {
    copy(vtkFloatArray::FastDownCast(points->GetData())->GetPointer(0));
  } else {
    copy(vtkDoubleArray::FastDownCast(points->GetData())->GetPointer(0));
  }
  data->SetPoints(points);
}

Bytes encodeAsVtp(const Coordinates& xyz, const VtpSettings& settings) {
  vtkNew<vtkPolyData> data;
  setPoints(data, xyz);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  writer->SetCompressorType(settings.compressor);
  writer->SetCompressionLevel(settings.level);
  writer->SetBlockSize(settings.block);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  if (writer->Write() == 0) throw std::runtime_error("VTK could not write the points");
  const std::string& text = writer->GetOutputString();
  return {text.begin(), text.end()};
}

Coordinates decodeVtp(const Bytes& bytes) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(bytes.begin(), bytes.end()));
  reader->Update();
  vtkPoints* points = reader->GetOutput()->GetPoints();
  if (points == nullptr) throw std::runtime_error("VTK could not read the points");
  Coordinates xyz(3 * static_cast<std::size_t>(points->GetNumberOfPoints()));
  const auto copy = [&xyz](const auto* from) {
    std::transform(from, from + xyz.size(), xyz.begin(),
                   [](auto c) { return static_cast<std::int32_t>(c); });
  };
  if (auto* single = vtkFloatArray::FastDownCast(points->GetData())) {
    copy(single->GetPointer(0));
  } else if (auto* twice = vtkDoubleArray::FastDownCast(points->GetData())) {
    copy(twice->GetPointer(0));
  } else {
    throw std::runtime_error("VTK has read coordinates of another type");
  }
  return xyz;
}

}  // namespace

std::vector<Codec> vtpCodecs() {
  constexpr int kMostLevel = 9;
  constexpr std::size_t kLargeBlock = std::size_t{1} << 22;
  const std::vector<std::pair<const char*, VtpSettings>> all{
      {"VTK .vtp LZ4", {vtkXMLWriter::LZ4}},
      {"VTK .vtp ZLib", {vtkXMLWriter::ZLIB}},
      {"VTK .vtp LZMA", {vtkXMLWriter::LZMA}},
      {"VTK .vtp LZMA 9", {vtkXMLWriter::LZMA, kMostLevel, kLargeBlock}}};
  std::vector<Codec> codecs;
  for (const auto& entry : all) {
    const VtpSettings settings = entry.second;
    codecs.push_back({entry.first, false,
                      [settings](const Coordinates& xyz, unsigned /*threads*/) {
                        return encodeAsVtp(xyz, settings);
                      },
                      [](const Bytes& bytes, unsigned /*threads*/) { return decodeVtp(bytes); }});
  }
  return codecs;
}

}  // namespace bspc::bench
