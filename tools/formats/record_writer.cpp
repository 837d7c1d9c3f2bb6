#include "formats/record_writer.h"

#include <algorithm>

#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// The source from point `first` on.
ScalarSource advanced(const ScalarSource& source, std::uint64_t first) {
  ScalarSource moved = source;
  moved.data = static_cast<const std::uint8_t*>(source.data) + first * source.stride;
  return moved;
}

void swapRecords(std::vector<std::uint8_t>& block, std::size_t recordBytes, std::size_t count,
                 const std::vector<RecordField>& fields) {
  for (std::size_t i = 0; i < count; ++i) {
    for (const RecordField& field : fields) {
      std::uint8_t* at = block.data() + i * recordBytes + field.offset;
      std::reverse(at, at + scalarSize(field.type));
    }
  }
}

/// Whether the points in memory are the records of the file, byte for byte.
bool isRecordImage(const PointSetView& points, const std::vector<RecordField>& fields,
                   std::size_t recordBytes) {
  return fields.size() == 3 && hostIsLittleEndian() && fields[0].type == points.type() &&
         points.strideBytes() == recordBytes && recordBytes == 3 * scalarSize(points.type());
}

}  // namespace

ScalarSource componentOf(const ArrayView& array, std::size_t component) {
  const ScalarType type = array.type == ScalarType::Bit ? ScalarType::UInt8 : array.type;
  const std::size_t size = scalarSize(type);
  const std::size_t stride = array.strideBytes > 0 ? array.strideBytes : array.components * size;
  const auto* data = static_cast<const std::uint8_t*>(array.data);
  return {data == nullptr ? data : data + component * size, type, stride, false};
}

ScalarSource coordinatesOf(const PointSetView& points, std::size_t axis) {
  const auto* data = static_cast<const std::uint8_t*>(points.data());
  if (data != nullptr) data += axis * scalarSize(points.type());
  return {data, points.type(), points.strideBytes(), false};
}

void writeRecords(OutputBuffer& out, const PointSetView& points,
                  const std::vector<RecordField>& fields, std::size_t recordBytes,
                  const char* format) {
  if (isRecordImage(points, fields, recordBytes)) {
    return out.write(points.data(), points.size() * recordBytes);
  }
  constexpr std::size_t kBlock = 4096;
  std::vector<std::uint8_t> block(std::min<std::uint64_t>(kBlock, points.size()) * recordBytes);
  for (std::uint64_t first = 0; first < points.size(); first += kBlock) {
    const auto size =
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, points.size() - first));
    for (const RecordField& field : fields) {
      const ScalarSource source = field.array == RecordField::kPosition
                                      ? coordinatesOf(points, field.component)
                                      : componentOf(points.arrays()[field.array], field.component);
      const ScalarTarget target{block.data() + field.offset, field.type, recordBytes};
      const std::size_t exact = convertScalars(advanced(source, first), target, size);
      if (exact == size) continue;
      throw FormatError(quoted(field.name) + " of point " + grouped(first + exact) +
                        " is an integer that " + format + " cannot hold exactly");
    }
    if (!hostIsLittleEndian()) swapRecords(block, recordBytes, size, fields);
    out.text().append(reinterpret_cast<const char*>(block.data()), size * recordBytes);
    out.advance(first + size, points.size());
  }
}

void requireNumbers(const std::vector<ArrayDescription>& arrays, const char* format) {
  for (const ArrayDescription& array : arrays) {
    if (array.type != ScalarType::String) continue;
    throw FormatError(std::string(format) + " cannot hold the texts of the array " +
                      quoted(array.name) + "; CSV files can");
  }
}

}  // namespace bspc::formats
