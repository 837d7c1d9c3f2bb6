#include "formats/pcd_header.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "formats/model.h"
#include "formats/scalar_common.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// More than any point takes.
constexpr std::uint64_t kMostPointBytes = std::uint64_t{1} << 20;

std::optional<ScalarType> typeOf(std::string_view letter, std::uint64_t size) {
  constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes{{
      {"F", ScalarType::Float32},
      {"F", ScalarType::Float64},
      {"I", ScalarType::Int8},
      {"I", ScalarType::Int16},
      {"I", ScalarType::Int32},
      {"I", ScalarType::Int64},
      {"U", ScalarType::UInt8},
      {"U", ScalarType::UInt16},
      {"U", ScalarType::UInt32},
      {"U", ScalarType::UInt64},
  }};
  for (const auto& [known, type] : kTypes) {
    if (known == letter && scalarSize(type) == size) return type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(TextScanner& text) : text_(text) {}

  PcdHeader read() {
    while (readLine()) {
    }
    layOutFields();
    findPositions();
    countPoints();
    header_.arrays = pcdArrays(header_.fields);
    return std::move(header_);
  }

 private:
  /// False at the line DATA, which is the last.
  bool readLine() {
    if (!text_.nextLine()) text_.failAtEnd("the file ends inside the header; expected \"DATA\"");
    text_.cutComment('#');
    std::string_view word;
    if (!text_.nextToken(word)) return true;
    const std::string keyword(word);
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      take(names_, keyword);
    } else if (keyword == "TYPE") {
      take(types_, keyword);
    } else if (keyword == "SIZE") {
      takeNumbers(sizes_, keyword);
    } else if (keyword == "COUNT") {
      takeNumbers(counts_, keyword);
    } else if (keyword == "WIDTH") {
      width_ = number(keyword);
    } else if (keyword == "HEIGHT") {
      height_ = number(keyword);
    } else if (keyword == "POINTS") {
      points_ = number(keyword);
    } else if (keyword == "VIEWPOINT") {
      readViewpoint();
    } else if (keyword == "DATA") {
      readEncoding();
      return false;
    } else if (keyword != "VERSION") {
      text_.fail(
          "expected a line of a PCD header such as FIELDS, SIZE, TYPE, COUNT, WIDTH or DATA, "
          "found " +
          quoted(keyword));
    }
    return true;
  }

  void take(std::vector<std::string>& words, const std::string& keyword) {
    if (!words.empty()) text_.fail("a second line " + quoted(keyword));
    std::string_view word;
    while (text_.nextToken(word)) words.emplace_back(word);
  }

  void takeNumbers(std::vector<std::uint64_t>& numbers, const std::string& keyword) {
    if (!numbers.empty()) text_.fail("a second line " + quoted(keyword));
    std::string_view word;
    while (text_.nextToken(word)) numbers.push_back(parse(word, keyword));
  }

  std::uint64_t number(const std::string& keyword) {
    std::string_view word;
    text_.nextToken(word);
    return parse(word, keyword);
  }

  std::uint64_t parse(std::string_view word, const std::string& keyword) const {
    return text_.number<std::uint64_t>(word,
                                       [&keyword]() -> const std::string& { return keyword; });
  }

  /// Where the sensor was, and how it was turned; the origin without a turn says nothing.
  void readViewpoint() {
    constexpr std::array<double, 7> kNone{0, 0, 0, 1, 0, 0, 0};
    bool saysSomething = false;
    std::string numbers;
    for (const double none : kNone) {
      std::string_view word;
      text_.nextToken(word);
      const auto value = text_.number<double>(word, [] { return std::string("VIEWPOINT"); });
      saysSomething = saysSomething || value != none;
      numbers += (numbers.empty() ? "" : " ") + std::string(word);
    }
    if (saysSomething) header_.viewpoint = numbers;
  }

  void readEncoding() {
    std::string_view word;
    text_.nextToken(word);
    if (word == "ascii") {
      header_.encoding = PcdEncoding::Ascii;
    } else if (word == "binary") {
      header_.encoding = PcdEncoding::Binary;
    } else if (word == "binary_compressed") {
      header_.encoding = PcdEncoding::BinaryCompressed;
    } else {
      text_.fail("expected ascii, binary or binary_compressed, found " + quoted(word));
    }
  }

  void requireAsMany(std::size_t count, const char* keyword) const {
    if (count == names_.size()) return;
    text_.fail("the header has " + counted(names_.size(), "field", "fields") + " but " +
               grouped(count) + " in the line " + keyword);
  }

  void layOutFields() {
    if (names_.empty()) text_.fail("the header has no line FIELDS");
    if (counts_.empty()) counts_.assign(names_.size(), 1);
    requireAsMany(sizes_.size(), "SIZE");
    requireAsMany(types_.size(), "TYPE");
    requireAsMany(counts_.size(), "COUNT");
    std::set<std::string> seen;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] != "_" && !seen.insert(names_[i]).second) {
        text_.fail("a second field " + quoted(names_[i]));
      }
      const std::optional<ScalarType> type = typeOf(types_[i], sizes_[i]);
      if (!type) {
        text_.fail("the field " + quoted(names_[i]) + " is of TYPE " + quoted(types_[i]) +
                   " and SIZE " + grouped(sizes_[i]) +
                   "; expected F of 4 or 8 bytes, or I or U of 1, 2, 4 or 8");
      }
      header_.fields.push_back(
          {names_[i], *type, counts_[i], header_.pointBytes, header_.pointNumbers});
      if (counts_[i] > kMostPointBytes ||
          header_.pointBytes + counts_[i] * sizes_[i] > kMostPointBytes) {
        text_.fail("the field " + quoted(names_[i]) + " makes a point larger than 1 MiB");
      }
      header_.pointBytes += counts_[i] * sizes_[i];
      header_.pointNumbers += counts_[i];
    }
  }

  void findPositions() {
    std::array<ScalarType, 3> types{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name(1, "xyz"[k]);
      const auto found = std::find(names_.begin(), names_.end(), name);
      if (found == names_.end()) text_.fail("the header declares no field " + quoted(name));
      header_.xyz[k] = static_cast<std::size_t>(found - names_.begin());
      const PcdField& field = header_.axis(k);
      if (field.count != 1) {
        text_.fail("the field " + quoted(name) + " has " + grouped(field.count) +
                   " numbers a point; expected 1");
      }
      types[k] = field.type;
    }
    header_.positionType = commonScalarType(types);
  }

  void countPoints() {
    const std::uint64_t height = height_.value_or(1);
    if (!points_ && !width_) text_.fail("the header has neither POINTS nor WIDTH");
    if (width_ && *width_ != 0 && height > UINT64_MAX / *width_) {
      text_.fail("WIDTH and HEIGHT are too large");
    }
    header_.points = points_ ? *points_ : *width_ * height;
    if (width_ && header_.points != *width_ * height) {
      text_.fail("the header has POINTS " + grouped(header_.points) + " but WIDTH " +
                 grouped(*width_) + " and HEIGHT " + grouped(height));
    }
    header_.height = width_ ? height : 1;
    header_.width = width_.value_or(header_.points);
  }

  TextScanner& text_;
  PcdHeader header_;
  std::vector<std::string> names_;
  std::vector<std::string> types_;
  std::vector<std::uint64_t> sizes_;
  std::vector<std::uint64_t> counts_;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

}  // namespace

PcdHeader readPcdHeader(TextScanner& text) { return HeaderReader(text).read(); }

}  // namespace bspc::formats
