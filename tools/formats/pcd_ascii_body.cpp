#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "formats/array_tuples.h"
#include "formats/pcd_body.h"
#include "formats/scalar_text.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// A point a line; empty lines count for nothing.
class AsciiBody : public PcdBody {
 public:
  AsciiBody(TextScanner& text, const PcdHeader& header)
      : text_(text), header_(header), fieldOf_(fieldsOf(header)) {}

  void readPoints(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                  Span<ArrayValues> values) override {
    const std::size_t pointBytes = 3 * scalarSize(header_.positionType);
    for (std::size_t i = 0; i < count; ++i) {
      if (!nextContent()) {
        text_.failAtEnd("the file ends before " + pcdPlace(header_, first + i));
      }
      readPoint(first + i, positions + i * pointBytes, values);
    }
  }

  void requireEnd() override {
    if (!nextContent()) return;
    std::string_view token;
    text_.nextToken(token);
    text_.fail("trailing data after the last point: " + quoted(token));
  }

 private:
  bool nextContent() {
    while (text_.nextLine()) {
      if (!text_.rest().empty()) return true;
    }
    return false;
  }

  /// The field of each number of a point.
  static std::vector<std::size_t> fieldsOf(const PcdHeader& header) {
    std::vector<std::size_t> fields;
    for (std::size_t f = 0; f < header.fields.size(); ++f) {
      fields.insert(fields.end(), static_cast<std::size_t>(header.fields[f].count), f);
    }
    return fields;
  }

  /// Reads the numbers to where they are in a point of a binary file.
  void readPoint(std::uint64_t index, std::uint8_t* position, Span<ArrayValues> values) {
    // Nothing is set aside for numbers that the line is too short for.
    if (text_.rest().size() + 1 < 2 * header_.pointNumbers) failShort(index);
    record_.resize(static_cast<std::size_t>(header_.pointBytes));
    std::string_view token;
    std::uint64_t number = 0;
    for (; text_.nextToken(token); ++number) {
      if (number == header_.pointNumbers) failCount("more", index);
      const std::size_t f = fieldOf_[static_cast<std::size_t>(number)];
      readNumber(token, f, number - header_.fields[f].numberOffset, index, position, values);
    }
    if (number < header_.pointNumbers) failCount(grouped(number), index);
    for (std::size_t a = 0; a < values.size(); ++a) appendTupleOf(header_.arrays[a], values[a]);
  }

  void readNumber(std::string_view token, std::size_t fieldIndex, std::uint64_t place,
                  std::uint64_t index, std::uint8_t* position, Span<ArrayValues> values) {
    const PcdField& field = header_.fields[fieldIndex];
    const auto describe = [&] {
      return "field " + quoted(field.name) + " (" + scalarName(field.type) + ") of " +
             pcdPlace(header_, index);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      if (header_.xyz[k] != fieldIndex) continue;
      readCoordinate(text_, token, field.type, header_.positionType,
                     position + k * scalarSize(header_.positionType), describe);
      return;
    }
    if (values.empty() || field.name == "_") return;
    std::uint8_t* const to = record_.data() + field.byteOffset + place * scalarSize(field.type);
    readScalar(text_, token, field.type, to, describe);
    // The bytes of a colour are counted from the lowest.
    if (isPackedColour(field) && !hostIsLittleEndian()) std::reverse(to, to + 4);
  }

  void appendTupleOf(const PcdArray& array, ArrayValues& values) const {
    const std::size_t size = scalarSize(values.type);
    std::uint8_t* const tuple = appendTuples(values, 1);
    for (std::size_t k = 0; k < array.offsets.size(); ++k) {
      const std::uint64_t at = header_.fields[array.fields[k]].byteOffset + array.offsets[k];
      std::memcpy(tuple + k * size, record_.data() + at, size);
    }
  }

  [[noreturn]] void failShort(std::uint64_t index) {
    std::string_view token;
    std::uint64_t found = 0;
    while (text_.nextToken(token)) ++found;
    failCount(grouped(found), index);
  }

  [[noreturn]] void failCount(const std::string& found, std::uint64_t index) const {
    text_.fail("expected " + counted(header_.pointNumbers, "number", "numbers") + " of " +
               pcdPlace(header_, index) + ", found " + found);
  }

  TextScanner& text_;
  const PcdHeader& header_;
  std::vector<std::size_t> fieldOf_;
  std::vector<std::uint8_t> record_;
};

}  // namespace

std::unique_ptr<PcdBody> asciiPcdBody(TextScanner& text, const PcdHeader& header) {
  return std::make_unique<AsciiBody>(text, header);
}

}  // namespace bspc::formats
