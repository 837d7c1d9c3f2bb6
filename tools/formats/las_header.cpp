#include "formats/las_header.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "formats/las_point.h"
#include "formats/las_records.h"
#include "formats/little_endian.h"
#include "formats/number_text.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr std::size_t kLeastHeader = 227;
constexpr std::size_t kLeastHeader14 = 375;
constexpr std::size_t kRecordHead = 54;
/// Bytes in front of the points that nobody declares are kept up to this size.
constexpr std::uint64_t kMostGap = 1 << 16;

[[noreturn]] void fail(const std::string& what, std::uint64_t byte) {
  throw FormatError(what + " (byte " + grouped(byte) + ")");
}

/// Text of a field of fixed length, which zeros end.
std::string_view fixedText(const char* field, std::size_t bytes) {
  return {field, static_cast<std::size_t>(std::find(field, field + bytes, '\0') - field)};
}

std::string threeNumbers(const std::array<double, 3>& numbers) {
  std::string text;
  for (const double number : numbers) {
    if (!text.empty()) text += ' ';
    appendNumber(text, number);
  }
  return text;
}

std::string hexOf(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15U];
  }
  return text;
}

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
    keepHeader();
    readPlaceOfPoints();
    nameOtherContent();
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
    if (format >= kLasPointFormats) {
      fail("point format " + std::to_string(format) + " is not known; expected 0 to 10", 104);
    }
    header_.pointFormat = format;
    header_.recordBytes = loadUInt16(at(105));
    if (header_.recordBytes < lasRecordBytes(format)) {
      fail("points of " + std::to_string(header_.recordBytes) +
               " bytes are too short for point format " + std::to_string(format) +
               ", which takes " + std::to_string(lasRecordBytes(format)),
           105);
    }
  }

  void readCount() {
    header_.points = loadUInt32(at(107));
    // The second bit of the global encoding says that waveforms follow the points.
    const bool within = (static_cast<unsigned char>(*at(6)) & 2U) != 0;
    header_.hasWaveforms =
        within && header_.minorVersion >= 3 && lasHasWaveforms(header_.pointFormat);
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

  void keep(const char* key, const std::string& text) {
    if (!text.empty()) header_.metadata.entries.emplace_back(key, text);
  }

  void keepHeader() {
    const auto number = [&](std::size_t byte) { return std::to_string(loadUInt16(at(byte))); };
    keep("las.version", "1." + std::to_string(header_.minorVersion));
    keep("las.point_format", std::to_string(header_.pointFormat));
    keep("las.scale", threeNumbers(header_.scale));
    keep("las.offset", threeNumbers(header_.offset));
    keep("las.system_identifier", utf8(fixedText(at(26), 32)));
    keep("las.generating_software", utf8(fixedText(at(58), 32)));
    if (loadUInt32(at(90)) != 0) keep("las.creation", number(90) + " " + number(92));
    // Both places were reserved in versions before.
    if (loadUInt16(at(4)) != 0) keep("las.file_source_id", number(4));
    if (loadUInt16(at(6)) != 0) keep("las.global_encoding", number(6));
    const std::string_view guid(at(8), 16);
    if (guid.find_first_not_of('\0') != std::string_view::npos) keep("las.guid", hexOf(guid));
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
    readGap(points - in_.offset());
  }

  void skip(std::uint64_t bytes) {
    if (in_.skip(bytes) < bytes) fail("the file ends before the first point", in_.offset());
  }

  /// The records between header and points. A record that does not fit there ends them: what is
  /// left then counts as bytes of the writer's own, which the format allows.
  void readRecords(std::uint32_t count, std::uint64_t points) {
    std::vector<LasRecord> records;
    for (std::uint32_t i = 0; i < count && points - in_.offset() >= kRecordHead; ++i) {
      if (!in_.ensure(kRecordHead)) skip(kRecordHead);
      LasRecord record;
      record.user = fixedText(in_.data() + 2, 16);
      record.id = loadUInt16(in_.data() + 18);
      record.description = fixedText(in_.data() + 22, 32);
      const std::size_t bytes = loadUInt16(in_.data() + 20);
      if (points - in_.offset() - kRecordHead < bytes) break;
      skip(kRecordHead);
      record.payload = take(bytes);
      if (record.is(kLasSpecification, kLasExtraDescriptions)) {
        header_.extraDescriptions = record.payload;
      }
      records.push_back(std::move(record));
    }
    keepLasRecords(records, header_.metadata);
  }

  Bytes take(std::size_t bytes) {
    if (!in_.ensure(bytes)) skip(bytes);
    Bytes taken(in_.data(), in_.data() + bytes);
    in_.consume(bytes);
    return taken;
  }

  /// Bytes between records and points, of which nobody says what they are.
  void readGap(std::uint64_t bytes) {
    // Two bytes mark the start of the points in version 1.0.
    const bool isMark = header_.minorVersion == 0 && bytes == 2;
    if (bytes == 0 || isMark || bytes > kMostGap) {
      if (bytes > kMostGap) {
        header_.otherContent.push_back({counted(bytes, "byte", "bytes") + " in front of the points",
                                        OtherContent::Kind::Rest});
      }
      return skip(bytes);
    }
    ArrayValues gap;
    gap.name = "las.gap";
    gap.type = ScalarType::UInt8;
    gap.values = take(static_cast<std::size_t>(bytes));
    header_.metadata.fieldData.push_back(std::move(gap));
  }

  void nameOtherContent() {
    std::vector<OtherContent>& content = header_.otherContent;
    if (header_.extendedRecords > 0) {
      content.push_back({counted(header_.extendedRecords, "extended record", "extended records"),
                         OtherContent::Kind::Rest});
    }
    if (header_.hasWaveforms) content.push_back({"waveforms", OtherContent::Kind::Rest});
  }

  InputBuffer& in_;
  LasHeader header_;
};

}  // namespace

LasHeader readLasHeader(InputBuffer& in) { return HeaderReader(in).read(); }

}  // namespace bspc::formats
