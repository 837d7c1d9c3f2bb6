#include "draco_array_size.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud.h>
#include <vtkDataArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "bspc/grid.h"
#include "vtk_support/array_types.h"

namespace bspc {

namespace {

draco::DataType dracoType(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
      return draco::DT_FLOAT32;
    case ScalarType::Float64:
      return draco::DT_FLOAT64;
    case ScalarType::Int8:
      return draco::DT_INT8;
    case ScalarType::UInt8:
      return draco::DT_UINT8;
    case ScalarType::Int16:
      return draco::DT_INT16;
    case ScalarType::UInt16:
      return draco::DT_UINT16;
    case ScalarType::Int32:
      return draco::DT_INT32;
    case ScalarType::UInt32:
      return draco::DT_UINT32;
    case ScalarType::Int64:
      return draco::DT_INT64;
    case ScalarType::UInt64:
      return draco::DT_UINT64;
    case ScalarType::Bit:
    case ScalarType::String:
      break;
  }
  return draco::DT_INVALID;
}

void addAttribute(draco::PointCloud& cloud, draco::GeometryAttribute::Type kind,
                  draco::DataType type, int components, const void* values) {
  draco::GeometryAttribute attribute;
  const auto stride = static_cast<std::int64_t>(components) * draco::DataTypeLength(type);
  attribute.Init(kind, nullptr, static_cast<std::int8_t>(components), type, false, stride, 0);
  const int id = cloud.AddAttribute(attribute, true, cloud.num_points());
  std::memcpy(cloud.attribute(id)->buffer()->data(), values,
              static_cast<std::size_t>(stride) * cloud.num_points());
}

/// The values of all attributes, point by point, in ascending order.
std::vector<std::string> sortedTuples(const draco::PointCloud& cloud) {
  std::vector<std::string> tuples(cloud.num_points());
  std::vector<char> value;
  for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
    for (int a = 0; a < cloud.num_attributes(); ++a) {
      const draco::PointAttribute* attribute = cloud.attribute(a);
      value.resize(static_cast<std::size_t>(attribute->byte_stride()));
      attribute->GetMappedValue(draco::PointIndex(i), value.data());
      tuples[i].append(value.data(), value.size());
    }
  }
  std::sort(tuples.begin(), tuples.end());
  return tuples;
}

}  // namespace

std::optional<std::size_t> dracoSize(vtkPolyData* data, vtkAbstractArray* array, bool kdTree) {
  vtkDataArray* positions = data->GetPoints()->GetData();
  const auto count = static_cast<std::size_t>(data->GetNumberOfPoints());
  const auto type = vtk::scalarTypeOfVtk(positions->GetDataType());
  const GridFit fit = fitGrid(PointSetView(positions->GetVoidPointer(0), *type, count, 0),
                              GridRequest::automatic());
  if (!fit.exact || fit.points.size() != count) return std::nullopt;

  draco::PointCloud cloud;
  cloud.set_num_points(static_cast<std::uint32_t>(count));
  addAttribute(cloud, draco::GeometryAttribute::POSITION, draco::DT_UINT32, 3, fit.points.data());
  if (array != nullptr) {
    const auto stored = vtk::scalarTypeOfVtk(array->GetDataType());
    const draco::DataType arrayType = stored ? dracoType(*stored) : draco::DT_INVALID;
    if (arrayType == draco::DT_INVALID) return std::nullopt;
    addAttribute(cloud, draco::GeometryAttribute::GENERIC, arrayType,
                 array->GetNumberOfComponents(), array->GetVoidPointer(0));
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(kdTree ? draco::POINT_CLOUD_KD_TREE_ENCODING
                                   : draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(0, 0);
  draco::EncoderBuffer bytes;
  if (!encoder.EncodePointCloudToBuffer(cloud, &bytes).ok()) return std::nullopt;
  draco::DecoderBuffer input;
  input.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodePointCloudFromBuffer(&input);
  if (!decoded.ok() || sortedTuples(*decoded.value()) != sortedTuples(cloud)) return std::nullopt;
  return bytes.size();
}

}  // namespace bspc
