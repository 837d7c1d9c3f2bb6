#include "formats/las_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "formats/las_plan.h"
#include "formats/las_records.h"
#include "formats/little_endian.h"
#include "formats/number_text.h"
#include "formats/record_writer.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr std::size_t kReturns = 15;

/// What the header says of the points themselves.
struct Summary {
  std::array<std::int32_t, 3> least{};
  std::array<std::int32_t, 3> most{};
  std::array<std::uint64_t, kReturns> byReturn{};
};

std::size_t headerBytes(unsigned minorVersion) {
  return minorVersion == 4 ? 375 : (minorVersion == 3 ? 235 : 227);
}

/// The field at a place of the header.
template <class T>
void set(std::string& header, std::size_t at, T value) {
  std::array<char, sizeof(T)> bytes{};
  storeLittleEndian(bytes.data(), value);
  header.replace(at, sizeof(T), bytes.data(), sizeof(T));
}

void setText(std::string& header, std::size_t at, std::size_t bytes, const std::string& text) {
  header.replace(at, std::min(bytes, text.size()), text, 0, bytes);
}

class LasWriter : public PointWriter {
 public:
  explicit LasWriter(const ModelLayout& layout) : layout_(layout), plan_(planLas(layout)) {
    for (LasRecord& record : lasRecordsOf(layout.metadata)) {
      if (record.is(kLasSpecification, kLasExtraDescriptions)) continue;
      if (record.payload.size() <= UINT16_MAX) records_.push_back(std::move(record));
    }
    if (!plan_.extraDescriptions.empty()) {
      records_.push_back(
          {kLasSpecification, kLasExtraDescriptions, "extra bytes", plan_.extraDescriptions});
    }
    for (const ArrayValues& array : layout.metadata.fieldData) {
      if (array.name == "las.gap") gap_ = array.values;
    }
    for (const LasFilledField& field : plan_.fields) {
      if (field.field.array.name == "ReturnNumber") returnNumber_ = field.array;
    }
    summary_.least.fill(std::numeric_limits<std::int32_t>::max());
    summary_.most.fill(std::numeric_limits<std::int32_t>::min());
  }

  void begin(OutputBuffer& out) override {
    out.text() += header();
    for (const LasRecord& record : records_) appendRecord(out.text(), record);
    out.text().append(gap_.begin(), gap_.end());
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    constexpr std::uint64_t kBlock = 4096;
    for (std::uint64_t first = 0; first < points.size(); first += kBlock) {
      const auto count =
          static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, points.size() - first));
      block_.assign(count * plan_.recordBytes, 0);
      storePositions(points, first, count);
      for (const LasFilledField& field : plan_.fields) {
        for (std::size_t k = 0; k < field.field.array.components; ++k) {
          storeField(points, first, count, field, k);
        }
      }
      for (const LasExtraNumber& extra : plan_.extras) storeExtra(points, first, count, extra);
      out.text().append(reinterpret_cast<const char*>(block_.data()), block_.size());
      written_ += count;
      out.advance(first + count, points.size());
    }
  }

  void finish(OutputBuffer& out) override {
    if (layout_.mayPatch && layout_.points > 0) {
      hasSummary_ = true;
      out.overwriteStart(header());
    }
  }

  double greatestError() const override { return error_; }

 private:
  std::string header() const {
    const std::size_t bytes = headerBytes(plan_.minorVersion);
    std::string head(bytes, '\0');
    setText(head, 0, 4, "LASF");
    set(head, 4, static_cast<std::uint16_t>(numberEntry("las.file_source_id")));
    set(head, 6, globalEncoding());
    setGuid(head);
    head[24] = 1;
    head[25] = static_cast<char>(plan_.minorVersion);
    setText(head, 26, 32, textEntry("las.system_identifier", "OTHER"));
    setText(head, 58, 32, textEntry("las.generating_software", "bspc"));
    const std::string creation = metadataEntry(layout_.metadata, "las.creation");
    const std::size_t blank = std::min(creation.find(' '), creation.size());
    set(head, 90, static_cast<std::uint16_t>(number(creation.substr(0, blank))));
    if (blank < creation.size()) {
      set(head, 92, static_cast<std::uint16_t>(number(creation.substr(blank + 1))));
    }
    set(head, 94, static_cast<std::uint16_t>(bytes));
    std::uint64_t start = bytes + gap_.size();
    for (const LasRecord& record : records_) start += 54 + record.payload.size();
    set(head, 96, static_cast<std::uint32_t>(start));
    set(head, 100, static_cast<std::uint32_t>(records_.size()));
    head[104] = static_cast<char>(plan_.pointFormat);
    set(head, 105, static_cast<std::uint16_t>(plan_.recordBytes));
    setCounts(head);
    for (std::size_t k = 0; k < 3; ++k) {
      set(head, 131 + 8 * k, plan_.scale[k]);
      set(head, 155 + 8 * k, plan_.offset[k]);
      const std::array<double, 2> range = rangeOf(k);
      set(head, 179 + 16 * k, range[1]);
      set(head, 187 + 16 * k, range[0]);
    }
    return head;
  }

  /// The old places of counts stay 0 where only the new ones may be read.
  void setCounts(std::string& head) const {
    const bool isOld = plan_.pointFormat < 6 && layout_.points <= UINT32_MAX;
    if (isOld) {
      set(head, 107, static_cast<std::uint32_t>(layout_.points));
      for (std::size_t r = 0; hasSummary_ && r < 5; ++r) {
        set(head, 111 + 4 * r, static_cast<std::uint32_t>(summary_.byReturn[r]));
      }
    }
    if (plan_.minorVersion < 4) return;
    set(head, 247, layout_.points);
    for (std::size_t r = 0; hasSummary_ && r < kReturns; ++r) {
      set(head, 255 + 8 * r, summary_.byReturn[r]);
    }
  }

  std::array<double, 2> rangeOf(std::size_t k) const {
    if (!hasSummary_) {
      if (!layout_.bounds) return {0, 0};
      return {(*layout_.bounds)[0][k], (*layout_.bounds)[1][k]};
    }
    const std::array<double, 2> ends{coordinate(k, summary_.least[k]),
                                     coordinate(k, summary_.most[k])};
    return {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  }

  double coordinate(std::size_t k, std::int32_t x) const {
    return x * plan_.scale[k] + plan_.offset[k];
  }

  std::uint16_t globalEncoding() const {
    constexpr unsigned kWaveformsWithin = 2;
    constexpr unsigned kWkt = 16;
    unsigned encoding = numberEntry("las.global_encoding") & ~kWaveformsWithin;
    const bool hasWkt = std::any_of(records_.begin(), records_.end(), [](const LasRecord& r) {
      return r.is(kLasProjection, kLasWkt);
    });
    if (hasWkt && plan_.pointFormat >= 6) encoding |= kWkt;
    return static_cast<std::uint16_t>(encoding);
  }

  void setGuid(std::string& head) const {
    const std::string hex = metadataEntry(layout_.metadata, "las.guid");
    if (hex.size() != 32 || hex.find_first_not_of("0123456789abcdef") != std::string::npos) return;
    const auto digit = [&](std::size_t i) {
      return static_cast<unsigned>(hex[i] <= '9' ? hex[i] - '0' : hex[i] - 'a' + 10);
    };
    for (std::size_t i = 0; i < 16; ++i) {
      head[8 + i] = static_cast<char>(16 * digit(2 * i) + digit(2 * i + 1));
    }
  }

  static unsigned number(const std::string& text) {
    unsigned value = 0;
    return parseNumber(text, value) == NumberStatus::Ok && value <= UINT16_MAX ? value : 0;
  }
  unsigned numberEntry(const char* key) const {
    return number(metadataEntry(layout_.metadata, key));
  }
  std::string textEntry(const char* key, const char* otherwise) const {
    std::string text = metadataEntry(layout_.metadata, key);
    return text.empty() ? otherwise : text;
  }

  static void appendRecord(std::string& text, const LasRecord& record) {
    std::string head(54, '\0');
    setText(head, 2, 16, record.user);
    set(head, 18, static_cast<std::uint16_t>(record.id));
    set(head, 20, static_cast<std::uint16_t>(record.payload.size()));
    setText(head, 22, 32, record.description);
    text += head;
    text.append(record.payload.begin(), record.payload.end());
  }

  void storePositions(const PointSetView& points, std::uint64_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<double, 3> p = points.position(first + i);
      std::uint8_t* const record = block_.data() + i * plan_.recordBytes;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = std::round((p[k] - plan_.offset[k]) / plan_.scale[k]);
        if (!(x >= std::numeric_limits<std::int32_t>::min() &&
              x <= std::numeric_limits<std::int32_t>::max())) {
          throw FormatError(std::string(1, "xyz"[k]) + " of point " + grouped(written_ + i) +
                            " is too large for the 32 bits that a LAS file has at its scale");
        }
        const auto whole = static_cast<std::int32_t>(x);
        storeLittleEndian(record + 4 * k, whole);
        noteError(std::fabs(coordinate(k, whole) - p[k]), std::fabs(p[k]), k);
        summary_.least[k] = std::min(summary_.least[k], whole);
        summary_.most[k] = std::max(summary_.most[k], whole);
      }
    }
  }

  /// The last bits of a double are the arithmetic of LAS, no movement.
  void noteError(double error, double magnitude, std::size_t k) {
    constexpr double kArithmetic = 4.0 / (std::int64_t{1} << 53);
    if (error > kArithmetic * std::max(magnitude, std::fabs(plan_.offset[k]))) {
      error_ = std::max(error_, error);
    }
  }

  void storeField(const PointSetView& points, std::uint64_t first, std::size_t count,
                  const LasFilledField& filled, std::size_t component) {
    const LasField& field = filled.field;
    const ScalarSource source = componentOf(points.arrays()[filled.array], component);
    const auto* from = static_cast<const std::uint8_t*>(source.data) + first * source.stride;
    std::uint8_t* to = block_.data() + field.offset + component * scalarSize(field.array.type);
    if (field.bits == 0 && filled.factor == 1) {
      return storeNumbers({from, source.type, source.stride, false}, to, count);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const unsigned value = from[i * source.stride];
      std::uint8_t* const at = to + i * plan_.recordBytes;
      if (field.bits == 0) {
        storeLittleEndian(at, static_cast<std::uint16_t>(value * filled.factor));
        continue;
      }
      if (value > field.mask()) failRange(field, value, i);
      *at = static_cast<std::uint8_t>(*at | (value << field.shift));
      const bool counts = filled.array == returnNumber_ && value >= 1 && value <= kReturns;
      if (counts) ++summary_.byReturn[value - 1];
    }
  }

  [[noreturn]] void failRange(const LasField& field, unsigned value, std::size_t index) const {
    throw FormatError(quoted(field.array.name) + " of point " + grouped(written_ + index) + " is " +
                      std::to_string(value) + "; point format " +
                      std::to_string(plan_.pointFormat) + " of LAS holds at most " +
                      std::to_string(field.mask()));
  }

  void storeExtra(const PointSetView& points, std::uint64_t first, std::size_t count,
                  const LasExtraNumber& extra) {
    const ScalarSource source = componentOf(points.arrays()[extra.array], extra.component);
    const auto* from = static_cast<const std::uint8_t*>(source.data) + first * source.stride;
    storeNumbers({from, source.type, source.stride, false}, block_.data() + extra.offset, count);
  }

  /// Numbers go out little endian: what swaps them on the way in swaps them on the way out.
  void storeNumbers(const ScalarSource& source, std::uint8_t* to, std::size_t count) const {
    ScalarSource little = source;
    little.swapped = !hostIsLittleEndian();
    convertScalars(little, {to, source.type, plan_.recordBytes}, count);
  }

  ModelLayout layout_;
  LasPlan plan_;
  std::vector<LasRecord> records_;
  Bytes gap_;
  std::size_t returnNumber_ = SIZE_MAX;
  std::vector<std::uint8_t> block_;
  Summary summary_;
  bool hasSummary_ = false;
  std::uint64_t written_ = 0;
  double error_ = 0;
};

}  // namespace

std::unique_ptr<PointWriter> lasWriter(const ModelLayout& layout) {
  return std::make_unique<LasWriter>(layout);
}

}  // namespace bspc::formats
