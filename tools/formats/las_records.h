#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/arrays.h"

namespace bspc::formats {

/// A variable length record of a LAS file.
struct LasRecord {
  std::string user;
  unsigned id = 0;
  std::string description;
  Bytes payload;

  bool is(const char* wantedUser, unsigned wantedId) const {
    return user == wantedUser && id == wantedId;
  }
};

constexpr const char* kLasProjection = "LASF_Projection";
constexpr unsigned kLasWkt = 2112;
constexpr unsigned kLasGeoKeys = 34735;
constexpr const char* kLasSpecification = "LASF_Spec";
constexpr unsigned kLasExtraDescriptions = 4;

/// Keeps records in metadata: number n as the entry "las.vlr.n", which is "user:id:description",
/// and its payload as the field data of that name, but for WKT that becomes Metadata::crs. Without
/// WKT, the code of a coordinate system that GeoTIFF keys tell becomes that, "EPSG:32610".
void keepLasRecords(const std::vector<LasRecord>& records, Metadata& metadata);

/// The records that metadata keep; a WKT of Metadata::crs is the payload of its record, which is
/// made if there is none.
std::vector<LasRecord> lasRecordsOf(const Metadata& metadata);

/// The value of an entry, empty if there is none.
std::string metadataEntry(const Metadata& metadata, const std::string& key);

}  // namespace bspc::formats
