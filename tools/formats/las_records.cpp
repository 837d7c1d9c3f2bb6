#include "formats/las_records.h"

#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/little_endian.h"
#include "formats/number_text.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr const char* kKeyStem = "las.vlr.";

/// The payload as text, if it is that and no more than one zero ends it.
std::optional<std::string> plainText(const Bytes& payload) {
  std::string text(payload.begin(), payload.end());
  if (!text.empty() && text.back() == '\0') text.pop_back();
  if (text.empty() || text.find('\0') != std::string::npos || utf8(text) != text) {
    return std::nullopt;
  }
  return text;
}

/// What GeoTIFF keys tell in numbers: four of 16 bits a key, the fourth the value where the second
/// is 0 ("OGC GeoTIFF Standard 1.1", 7.1).
std::optional<unsigned> geoKey(const LasRecord& keys, unsigned wanted) {
  for (std::size_t at = 8; at + 8 <= keys.payload.size(); at += 8) {
    const std::uint8_t* const key = keys.payload.data() + at;
    if (loadUInt16(key) == wanted && loadUInt16(key + 2) == 0) return loadUInt16(key + 6);
  }
  return std::nullopt;
}

void keepGeoKeys(const LasRecord& keys, Metadata& metadata) {
  constexpr unsigned kModel = 1024;
  constexpr unsigned kGeographic = 2048;
  constexpr unsigned kProjected = 3072;
  constexpr unsigned kLinearUnit = 3076;
  constexpr unsigned kUserDefined = 32767;
  const bool isGeographic = geoKey(keys, kModel) == 2U;
  const auto code = geoKey(keys, isGeographic ? kGeographic : kProjected);
  if (metadata.crs.empty() && code && *code != 0 && *code < kUserDefined) {
    metadata.crs = "EPSG:" + std::to_string(*code);
  }
  const auto unit = geoKey(keys, kLinearUnit);
  if (isGeographic || !unit) return;
  if (*unit == 9001) metadata.lengthUnit = "m";
  if (*unit == 9002) metadata.lengthUnit = "ft";
  if (*unit == 9003) metadata.lengthUnit = "ftUS";
}

bool isWkt(const std::string& crs) { return !crs.empty() && crs.find('[') != std::string::npos; }

/// "user:id:description" as a record without payload.
std::optional<LasRecord> parseRecord(const std::string& text) {
  for (std::size_t colon = text.find(':'); colon != std::string::npos;
       colon = text.find(':', colon + 1)) {
    const std::size_t end = text.find(':', colon + 1);
    if (end == std::string::npos) break;
    LasRecord record;
    const auto number = std::string_view(text).substr(colon + 1, end - colon - 1);
    if (parseNumber(number, record.id) != NumberStatus::Ok || record.id > UINT16_MAX) continue;
    record.user = text.substr(0, colon);
    record.description = text.substr(end + 1);
    return record;
  }
  return std::nullopt;
}

}  // namespace

void keepLasRecords(const std::vector<LasRecord>& records, Metadata& metadata) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LasRecord& record = records[i];
    const std::string key = kKeyStem + std::to_string(i + 1);
    metadata.entries.emplace_back(
        key, utf8(record.user + ":" + std::to_string(record.id) + ":" + record.description));
    if (record.is(kLasProjection, kLasWkt) && metadata.crs.empty()) {
      const std::optional<std::string> text = plainText(record.payload);
      if (text && isWkt(*text)) {
        metadata.crs = *text;
        continue;
      }
    }
    if (record.payload.empty()) continue;
    ArrayValues payload;
    payload.name = key;
    payload.type = ScalarType::UInt8;
    payload.values = record.payload;
    metadata.fieldData.push_back(std::move(payload));
  }
  for (const LasRecord& record : records) {
    if (record.is(kLasProjection, kLasGeoKeys)) keepGeoKeys(record, metadata);
  }
}

std::vector<LasRecord> lasRecordsOf(const Metadata& metadata) {
  std::vector<LasRecord> records;
  bool needsWkt = isWkt(metadata.crs);
  const Bytes wkt = [&] {
    Bytes bytes(metadata.crs.begin(), metadata.crs.end());
    bytes.push_back(0);
    return bytes;
  }();
  std::map<std::string_view, const ArrayValues*> payloads;
  for (const ArrayValues& array : metadata.fieldData) payloads.emplace(array.name, &array);
  for (const auto& [key, text] : metadata.entries) {
    if (key.rfind(kKeyStem, 0) != 0) continue;
    std::optional<LasRecord> record = parseRecord(text);
    if (!record) continue;
    const auto payload = payloads.find(key);
    if (payload != payloads.end()) {
      record->payload = payload->second->values;
    } else if (record->is(kLasProjection, kLasWkt) && needsWkt) {
      record->payload = wkt;
      needsWkt = false;
    }
    records.push_back(std::move(*record));
  }
  if (needsWkt) records.push_back({kLasProjection, kLasWkt, "coordinate system", wkt});
  return records;
}

std::string metadataEntry(const Metadata& metadata, const std::string& key) {
  for (const auto& [known, text] : metadata.entries) {
    if (known == key) return text;
  }
  return "";
}

}  // namespace bspc::formats
