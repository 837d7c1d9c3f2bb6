#include "formats/ply_writer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "formats/scalar_convert.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

const char* plyName(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
      return "float";
    case ScalarType::Float64:
      return "double";
    case ScalarType::Int8:
      return "char";
    case ScalarType::UInt8:
      return "uchar";
    case ScalarType::Int16:
      return "short";
    case ScalarType::UInt16:
      return "ushort";
    case ScalarType::Int32:
      return "int";
    case ScalarType::UInt32:
      return "uint";
    default:
      throw FormatError(std::string("a PLY file has no type ") + scalarName(type));
  }
}

/// One property of the file: where its numbers come from and as what they go out.
struct Property {
  std::string name;
  ScalarSource source;
  ScalarType type = ScalarType::Float32;
  std::size_t offset = 0;
};

/// The type that positions go out as.
ScalarType positionType(ScalarType type) {
  const bool wide = type == ScalarType::Int64 || type == ScalarType::UInt64;
  return wide ? ScalarType::Float64 : type;
}

/// uint if all values fit, else double.
ScalarType columnType(const ColumnLayout& column) {
  return column.greatest <= UINT32_MAX ? ScalarType::UInt32 : ScalarType::Float64;
}

std::vector<Property> listProperties(const ModelLayout& layout, const ModelView& model) {
  const PointSetView& points = model.points;
  std::vector<Property> properties;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto* data = static_cast<const std::uint8_t*>(points.data());
    if (data != nullptr) data += k * scalarSize(layout.type);
    properties.push_back({std::string(1, "xyz"[k]),
                          {data, layout.type, points.strideBytes(), false},
                          positionType(layout.type),
                          0});
  }
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const ColumnLayout& column = layout.columns[c];
    const std::uint64_t* values =
        c < model.columns.size() ? model.columns[c].values.data() : nullptr;
    properties.push_back({column.name,
                          {values, ScalarType::UInt64, sizeof(std::uint64_t), false},
                          columnType(column),
                          0});
  }
  std::size_t offset = 0;
  for (Property& property : properties) {
    property.offset = offset;
    offset += scalarSize(property.type);
  }
  return properties;
}

/// The source from point `first` on.
ScalarSource advanced(const ScalarSource& source, std::uint64_t first) {
  ScalarSource moved = source;
  moved.data = static_cast<const std::uint8_t*>(source.data) + first * source.stride;
  return moved;
}

void swapRecords(std::vector<std::uint8_t>& block, std::size_t recordBytes, std::size_t count,
                 const std::vector<Property>& properties) {
  for (std::size_t i = 0; i < count; ++i) {
    for (const Property& p : properties) {
      std::uint8_t* at = block.data() + i * recordBytes + p.offset;
      std::reverse(at, at + scalarSize(p.type));
    }
  }
}

void writeRecords(OutputBuffer& out, std::uint64_t count, const std::vector<Property>& properties) {
  constexpr std::size_t kBlock = 4096;
  const std::size_t recordBytes = properties.back().offset + scalarSize(properties.back().type);
  std::vector<std::uint8_t> block(kBlock * recordBytes);
  for (std::uint64_t first = 0; first < count; first += kBlock) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, count - first));
    for (const Property& p : properties) {
      const ScalarTarget target{block.data() + p.offset, p.type, recordBytes};
      const std::size_t exact = convertScalars(advanced(p.source, first), target, size);
      if (exact < size) {
        throw FormatError(quoted(p.name) + " of point " + grouped(first + exact) +
                          " is an integer that a PLY file cannot hold exactly");
      }
    }
    if (!hostIsLittleEndian()) swapRecords(block, recordBytes, size, properties);
    out.text().append(reinterpret_cast<const char*>(block.data()), size * recordBytes);
    out.advance(first + size, count);
  }
}

/// Whether the points in memory are the records of the file, byte for byte.
bool isRecordImage(const ModelView& model, const std::vector<Property>& properties) {
  return model.columns.empty() && hostIsLittleEndian() &&
         properties[0].type == model.points.type() &&
         model.points.strideBytes() == 3 * scalarSize(model.points.type());
}

}  // namespace

void writePlyHeader(std::string& text, const ModelLayout& layout) {
  text += "ply\nformat binary_little_endian 1.0\ncomment written by bspc\nelement vertex ";
  text += std::to_string(layout.points) + '\n';
  for (const Property& p : listProperties(layout, {})) {
    text += std::string("property ") + plyName(p.type) + ' ' + p.name + '\n';
  }
  text += "end_header\n";
}

void writePlyRecords(OutputBuffer& out, const ModelLayout& layout, const ModelView& model) {
  const std::uint64_t count = model.points.size();
  if (count == 0) return;
  const std::vector<Property> properties = listProperties(layout, model);
  if (isRecordImage(model, properties)) {
    out.write(model.points.data(), count * model.points.strideBytes());
  } else {
    writeRecords(out, count, properties);
  }
}

}  // namespace bspc::formats
