#include "formats/las_point.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "formats/array_columns.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Which groups of fields a point format has, and where they start; 0: it has them not.
struct PointFormat {
  std::size_t bytes;
  std::size_t time;
  std::size_t colours;
  std::size_t infrared;
  std::size_t waveform;
};

constexpr std::array<PointFormat, kLasPointFormats> kPointFormats{{
    {20, 0, 0, 0, 0},
    {28, 20, 0, 0, 0},
    {26, 0, 20, 0, 0},
    {34, 20, 28, 0, 0},
    {57, 20, 0, 0, 28},
    {63, 20, 28, 0, 34},
    {30, 22, 0, 0, 0},
    {36, 22, 30, 0, 0},
    {38, 22, 30, 36, 0},
    {59, 22, 0, 0, 30},
    {67, 22, 30, 36, 38},
}};

/// The scalar types by their numbers in descriptions of extra bytes, counted from 1.
constexpr std::array<ScalarType, 10> kExtraTypes{
    ScalarType::UInt8,   ScalarType::Int8,   ScalarType::UInt16, ScalarType::Int16,
    ScalarType::UInt32,  ScalarType::Int32,  ScalarType::UInt64, ScalarType::Int64,
    ScalarType::Float32, ScalarType::Float64};

LasField whole(const char* name, ScalarType type, std::size_t offset, const char* unit = "") {
  LasField field;
  field.array.name = name;
  field.array.type = type;
  field.array.unit = unit;
  field.offset = offset;
  return field;
}

LasField bits(const char* name, std::size_t offset, unsigned shift, unsigned count) {
  LasField field = whole(name, ScalarType::UInt8, offset);
  field.shift = shift;
  field.bits = count;
  return field;
}

/// Point formats 0 to 5.
std::vector<LasField> oldFields() {
  return {whole("Intensity", ScalarType::UInt16, 12),
          bits("ReturnNumber", 14, 0, 3),
          bits("NumberOfReturns", 14, 3, 3),
          bits("ScanDirectionFlag", 14, 6, 1),
          bits("EdgeOfFlightLine", 14, 7, 1),
          bits("Classification", 15, 0, 5),
          bits("Synthetic", 15, 5, 1),
          bits("KeyPoint", 15, 6, 1),
          bits("Withheld", 15, 7, 1),
          whole("ScanAngleRank", ScalarType::Int8, 16, "degree"),
          whole("UserData", ScalarType::UInt8, 17),
          whole("PointSourceId", ScalarType::UInt16, 18)};
}

/// Point formats 6 to 10.
std::vector<LasField> newFields() {
  return {whole("Intensity", ScalarType::UInt16, 12),
          bits("ReturnNumber", 14, 0, 4),
          bits("NumberOfReturns", 14, 4, 4),
          bits("Synthetic", 15, 0, 1),
          bits("KeyPoint", 15, 1, 1),
          bits("Withheld", 15, 2, 1),
          bits("Overlap", 15, 3, 1),
          bits("ScanChannel", 15, 4, 2),
          bits("ScanDirectionFlag", 15, 6, 1),
          bits("EdgeOfFlightLine", 15, 7, 1),
          whole("Classification", ScalarType::UInt8, 16),
          whole("UserData", ScalarType::UInt8, 17),
          whole("ScanAngle", ScalarType::Int16, 18, "0.006 degree"),
          whole("PointSourceId", ScalarType::UInt16, 20)};
}

LasField coloursAt(std::size_t offset) {
  LasField field = whole("RGB", ScalarType::UInt16, offset);
  field.array.components = 3;
  field.array.componentNames = {"red", "green", "blue"};
  field.array.semantic = Semantic::Colours;
  return field;
}

void appendWaveform(std::vector<LasField>& fields, std::size_t offset) {
  fields.push_back(whole("WavePacketDescriptor", ScalarType::UInt8, offset));
  fields.push_back(whole("WavePacketOffset", ScalarType::UInt64, offset + 1));
  fields.push_back(whole("WavePacketSize", ScalarType::UInt32, offset + 9));
  fields.push_back(whole("ReturnPointLocation", ScalarType::Float32, offset + 13));
  fields.push_back(whole("WaveDirection", ScalarType::Float32, offset + 17));
  fields.back().array.components = 3;
}

/// Text of a field of fixed length, which zeros end.
std::string_view fixedText(const std::uint8_t* field, std::size_t bytes) {
  return {reinterpret_cast<const char*>(field),
          static_cast<std::size_t>(std::find(field, field + bytes, 0) - field)};
}

/// The attribute that one description tells of, its place left out.
LasExtraField describedField(const std::uint8_t* description) {
  LasExtraField field;
  field.array.name = utf8(fixedText(description + 4, 32));
  const unsigned number = description[2];
  const auto types = static_cast<unsigned>(kExtraTypes.size());
  if (number == 0 || number > 3 * types) {
    // Bytes of no known type, whose number is where the options are otherwise.
    field.array.type = ScalarType::UInt8;
    field.array.components = number == 0 ? description[3] : 0;
  } else {
    field.array.type = kExtraTypes[(number - 1) % types];
    field.array.components = 1 + (number - 1) / types;
    field.isScalar = number <= types;
  }
  field.bytes = field.array.components * scalarSize(field.array.type);
  return field;
}

}  // namespace

std::size_t lasRecordBytes(unsigned pointFormat) { return kPointFormats[pointFormat].bytes; }

std::vector<LasField> lasFields(unsigned pointFormat) {
  const PointFormat& format = kPointFormats[pointFormat];
  std::vector<LasField> fields = pointFormat < 6 ? oldFields() : newFields();
  if (format.time > 0) fields.push_back(whole("GpsTime", ScalarType::Float64, format.time, "s"));
  if (format.colours > 0) fields.push_back(coloursAt(format.colours));
  if (format.infrared > 0) {
    fields.push_back(whole("Infrared", ScalarType::UInt16, format.infrared));
  }
  if (format.waveform > 0) appendWaveform(fields, format.waveform);
  return fields;
}

bool lasHasWaveforms(unsigned pointFormat) { return kPointFormats[pointFormat].waveform > 0; }

std::vector<LasExtraField> lasExtraFields(ByteView descriptions, std::size_t extraBytes) {
  std::vector<LasExtraField> fields;
  std::size_t offset = 0;
  for (std::size_t at = 0; descriptions.size() - at >= kLasExtraDescription;
       at += kLasExtraDescription) {
    LasExtraField field = describedField(descriptions.data() + at);
    if (field.bytes == 0 || field.bytes > extraBytes - offset) break;
    field.offset = offset;
    offset += field.bytes;
    fields.push_back(std::move(field));
  }
  if (offset == extraBytes) return fields;
  LasExtraField rest;
  rest.array.name = kLasExtraBytes;
  rest.array.type = ScalarType::UInt8;
  rest.array.components = static_cast<std::uint32_t>(extraBytes - offset);
  rest.offset = offset;
  rest.bytes = extraBytes - offset;
  fields.push_back(std::move(rest));
  return fields;
}

unsigned lasExtraType(ScalarType type) {
  const auto* const found = std::find(kExtraTypes.begin(), kExtraTypes.end(), type);
  return found == kExtraTypes.end() ? 0 : static_cast<unsigned>(found - kExtraTypes.begin()) + 1;
}

}  // namespace bspc::formats
