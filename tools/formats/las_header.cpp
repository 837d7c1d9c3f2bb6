#include "formats/las_header.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "formats/little_endian.h"
#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr std::size_t kLeastHeader = 227;
constexpr std::size_t kLeastHeader14 = 375;
constexpr std::size_t kRecordHead = 54;
constexpr std::size_t kExtraAttribute = 192;

[[noreturn]] void fail(const std::string& what, std::uint64_t byte) {
  throw FormatError(what + " (byte " + grouped(byte) + ")");
}

/// Text of a field of fixed length, which zeros end.
std::string_view fixedText(const char* field, std::size_t bytes) {
  return {field, static_cast<std::size_t>(std::find(field, field + bytes, '\0') - field)};
}

/// Which groups of attributes a point format has.
struct PointFormat {
  std::size_t bytes;
  bool time;
  bool colours;
  bool infrared;
  bool waveform;
};

constexpr std::array<PointFormat, 11> kPointFormats{{
    {20, false, false, false, false},
    {28, true, false, false, false},
    {26, false, true, false, false},
    {34, true, true, false, false},
    {57, true, false, false, true},
    {63, true, true, false, true},
    {30, true, false, false, false},
    {36, true, true, false, false},
    {38, true, true, true, false},
    {59, true, false, false, true},
    {67, true, true, true, true},
}};

class HeaderReader {
 public:
  explicit HeaderReader(InputBuffer& in) : in_(in) {}

  LasHeader read() {
    requireBytes(4);
    if (std::string_view(in_.data(), 4) != "LASF") {
      fail("not a LAS file: expected \"LASF\", found " + quoted({in_.data(), 4}), 0);
    }
    requireBytes(kLeastHeader);
    readVersion();
    readPointFormat();
    readCount();
    readScales();
    readPlaceOfPoints();
    return std::move(header_);
  }

 private:
  const char* at(std::size_t byte) const { return in_.data() + byte; }

  void requireBytes(std::size_t bytes) {
    if (in_.ensure(bytes)) return;
    fail("the file ends inside the header of " + grouped(bytes) + " bytes", in_.available());
  }

  void readVersion() {
    const auto major = static_cast<unsigned char>(*at(24));
    header_.minorVersion = static_cast<unsigned char>(*at(25));
    if (major == 1 && header_.minorVersion <= 4) return;
    fail("LAS version " + std::to_string(major) + "." + std::to_string(header_.minorVersion) +
             " is not supported; expected 1.0 to 1.4",
         24);
  }

  void readPointFormat() {
    const auto format = static_cast<unsigned char>(*at(104));
    // Compressors mark what they have done to the points in the two highest bits.
    if (format >= 64) {
      fail(
          "the points are compressed: this is a LAZ file; make a LAS file of it first, for example "
          "by las2las -i in.laz -o out.las or pdal translate in.laz out.las",
          104);
    }
    if (format >= kPointFormats.size()) {
      fail("point format " + std::to_string(format) + " is not known; expected 0 to 10", 104);
    }
    header_.pointFormat = format;
    header_.recordBytes = loadUInt16(at(105));
    if (header_.recordBytes < kPointFormats[format].bytes) {
      fail("points of " + std::to_string(header_.recordBytes) +
               " bytes are too short for point format " + std::to_string(format) +
               ", which takes " + std::to_string(kPointFormats[format].bytes),
           105);
    }
  }

  void readCount() {
    header_.points = loadUInt32(at(107));
    const bool hasWaveforms = kPointFormats[header_.pointFormat].waveform;
    header_.hasWaveforms = header_.minorVersion >= 3 && hasWaveforms;
    if (header_.minorVersion < 4) return;
    requireBytes(kLeastHeader14);
    header_.extendedRecords = loadUInt32(at(243));
    // Some writers of version 1.4 fill in the old field alone.
    const std::uint64_t points = loadUInt64(at(247));
    if (points != 0) header_.points = points;
  }

  void readScales() {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      header_.scale[k] = loadFloat64(at(131 + 8 * k));
      header_.offset[k] = loadFloat64(at(155 + 8 * k));
      if (!std::isfinite(header_.scale[k]) || header_.scale[k] == 0) {
        fail("the scale of " + axis + " must be a finite number other than 0", 131 + 8 * k);
      }
      if (!std::isfinite(header_.offset[k])) {
        fail("the offset of " + axis + " must be a finite number", 155 + 8 * k);
      }
    }
  }

  void readPlaceOfPoints() {
    const std::size_t headerBytes = loadUInt16(at(94));
    const std::size_t points = loadUInt32(at(96));
    const std::uint32_t records = loadUInt32(at(100));
    const std::size_t least = header_.minorVersion < 4 ? kLeastHeader : kLeastHeader14;
    if (headerBytes < least) {
      fail("a header of " + std::to_string(headerBytes) + " bytes is too short for version 1." +
               std::to_string(header_.minorVersion) + ", which takes " + std::to_string(least),
           94);
    }
    if (points < headerBytes) {
      fail("the points are said to start at byte " + grouped(points) + ", inside the header of " +
               grouped(headerBytes) + " bytes",
           96);
    }
    skip(headerBytes);
    readRecords(records, points);
    namePointAttributes();
    nameRecords(points - in_.offset());
    skip(points - in_.offset());
  }

  void skip(std::uint64_t bytes) {
    if (in_.skip(bytes) < bytes) fail("the file ends before the first point", in_.offset());
  }

  /// The records between header and points. A record that does not fit there ends them: what is
  /// left then counts as bytes of the writer's own, which the format allows.
  void readRecords(std::uint32_t count, std::uint64_t points) {
    for (std::uint32_t i = 0; i < count && points - in_.offset() >= kRecordHead; ++i) {
      if (!in_.ensure(kRecordHead)) skip(kRecordHead);
      const std::string user(fixedText(in_.data() + 2, 16));
      const unsigned id = loadUInt16(in_.data() + 18);
      const std::size_t bytes = loadUInt16(in_.data() + 20);
      if (points - in_.offset() - kRecordHead < bytes) return;
      skip(kRecordHead);
      if (user == "LASF_Spec" && id == 4) {
        readExtraAttributes(bytes);
        continue;
      }
      skip(bytes);
      const auto found = std::find_if(records_.begin(), records_.end(),
                                      [&](const auto& entry) { return entry.first == user; });
      if (found == records_.end()) {
        records_.emplace_back(user, 1);
      } else {
        ++found->second;
      }
    }
  }

  /// The record that describes bytes of a point beyond those of its format.
  void readExtraAttributes(std::size_t bytes) {
    constexpr std::array<ScalarType, 10> kTypes{
        ScalarType::UInt8,   ScalarType::Int8,   ScalarType::UInt16, ScalarType::Int16,
        ScalarType::UInt32,  ScalarType::Int32,  ScalarType::UInt64, ScalarType::Int64,
        ScalarType::Float32, ScalarType::Float64};
    for (; bytes >= kExtraAttribute; bytes -= kExtraAttribute) {
      if (!in_.ensure(kExtraAttribute)) break;
      const auto type = static_cast<unsigned char>(*(in_.data() + 2));
      const std::string_view name = fixedText(in_.data() + 4, 32);
      const bool isScalar = type >= 1 && type <= kTypes.size();
      extras_.push_back("point attribute " + quoted(name) +
                        (isScalar ? std::string(" (") + scalarName(kTypes[type - 1U]) + ")" : ""));
      skip(kExtraAttribute);
    }
    skip(bytes);
  }

  void namePointAttributes() {
    if (header_.points == 0) return;
    std::vector<std::string>& content = header_.otherContent;
    const PointFormat& format = kPointFormats[header_.pointFormat];
    content.emplace_back("point attribute \"intensity\" (uint16)");
    content.emplace_back("return numbers and flags");
    content.emplace_back("point attribute \"classification\" (uint8)");
    if (format.colours) content.emplace_back("colours (uint16)");
    if (format.infrared) content.emplace_back("point attribute \"near infrared\" (uint16)");
    if (format.time) content.emplace_back("point attribute \"GPS time\" (float64)");
    content.emplace_back(header_.pointFormat < 6 ? "point attribute \"scan angle\" (int8)"
                                                 : "point attribute \"scan angle\" (int16)");
    content.emplace_back("point attribute \"user data\" (uint8)");
    content.emplace_back("point attribute \"point source ID\" (uint16)");
    if (format.waveform) content.emplace_back("waveforms");
    const std::size_t extra = header_.recordBytes - format.bytes;
    if (extra == 0) return;
    if (extras_.empty()) {
      content.push_back(counted(extra, "extra byte", "extra bytes") + " a point");
    }
    content.insert(content.end(), extras_.begin(), extras_.end());
  }

  void nameRecords(std::uint64_t bytesLeft) {
    std::vector<std::string>& content = header_.otherContent;
    for (const auto& [user, count] : records_) {
      content.push_back(counted(count, "record ", "records ") + quoted(user));
    }
    // Two bytes mark the start of the points in version 1.0.
    if (bytesLeft > (header_.minorVersion == 0 ? 2U : 0U)) {
      content.push_back(counted(bytesLeft, "byte", "bytes") + " in front of the points");
    }
    if (header_.extendedRecords > 0) {
      content.push_back(counted(header_.extendedRecords, "extended record", "extended records"));
    }
  }

  InputBuffer& in_;
  LasHeader header_;
  /// Users of records, and how many records each has.
  std::vector<std::pair<std::string, std::uint64_t>> records_;
  std::vector<std::string> extras_;
};

}  // namespace

LasHeader readLasHeader(InputBuffer& in) { return HeaderReader(in).read(); }

}  // namespace bspc::formats
