#include "formats/xyz_columns.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

namespace bspc::formats {

namespace {

/// What the texts of a column can be read as.
class ColumnSurvey {
 public:
  void add(std::string_view field) {
    if (isText_) return;
    std::uint64_t large = 0;
    std::int64_t whole = 0;
    double number = 0;
    if (field.empty()) {
      hasEmpty_ = true;
    } else if (parseNumber(field, whole) == NumberStatus::Ok) {
      // Whole numbers know no −0.
      hasBroken_ = hasBroken_ || (whole == 0 && field.front() == '-');
      least_ = std::min(least_, whole);
      if (whole > 0) greatest_ = std::max(greatest_, static_cast<std::uint64_t>(whole));
      hasWhole_ = true;
    } else if (parseNumber(field, large) == NumberStatus::Ok) {
      greatest_ = std::max(greatest_, large);
      hasWhole_ = true;
    } else if (parseNumber(field, number) == NumberStatus::Ok) {
      hasBroken_ = true;
    } else {
      isText_ = true;
    }
  }

  ScalarType type() const {
    constexpr std::uint64_t kInt32 = std::numeric_limits<std::int32_t>::max();
    constexpr std::uint64_t kInt64 = std::numeric_limits<std::int64_t>::max();
    const bool hasNumbers = hasWhole_ || hasBroken_;
    if (isText_ || (hasEmpty_ && !hasNumbers)) return ScalarType::String;
    if (hasBroken_ || hasEmpty_ || !hasNumbers) return ScalarType::Float64;
    if (least_ >= std::numeric_limits<std::int32_t>::min() && greatest_ <= kInt32) {
      return ScalarType::Int32;
    }
    if (greatest_ <= kInt64) return ScalarType::Int64;
    return least_ >= 0 ? ScalarType::UInt64 : ScalarType::String;
  }

  bool isWithin(std::uint64_t greatest) const { return least_ >= 0 && greatest_ <= greatest; }

 private:
  bool hasEmpty_ = false;
  bool hasWhole_ = false;
  bool hasBroken_ = false;
  bool isText_ = false;
  std::int64_t least_ = 0;
  std::uint64_t greatest_ = 0;
};

void surveyLine(TextScanner& text, const XyzLayout& layout, std::vector<ColumnSurvey>& surveys) {
  std::string_view field;
  std::size_t column = 0;
  for (; column < surveys.size() && text.nextField(layout.separator, field); ++column) {
    if (layout.axisOf[column] == 3) surveys[column].add(field);
  }
  // Wrong numbers of columns are found when the points are read.
  for (; column < surveys.size(); ++column) surveys[column].add("");
}

/// Whether a file can be read again is asked of it; of a pipe, the first megabytes have to do.
std::vector<ColumnSurvey> survey(InputBuffer& in, TextScanner& text, const XyzLayout& layout) {
  std::vector<ColumnSurvey> surveys(layout.names.size());
  if (in.canSeek()) {
    const TextScanner::Place place = text.place();
    do surveyLine(text, layout, surveys);
    while (nextXyzContent(text, layout.separator));
    text.goTo(place);
    return surveys;
  }
  constexpr std::size_t kPrefix = std::size_t{4} << 20;
  surveyLine(text, layout, surveys);
  text.rewindLine();
  text.keepLine();
  const bool isAll = !in.ensure(kPrefix);
  std::string prefix(in.data(), in.available());
  // A line that was cut off says nothing.
  if (!isAll) prefix.resize(std::min(prefix.rfind('\n'), prefix.size()));
  std::istringstream stream(prefix);
  InputBuffer part(stream);
  TextScanner lines(part);
  while (nextXyzContent(lines, layout.separator)) surveyLine(lines, layout, surveys);
  return surveys;
}

}  // namespace

std::vector<GroupedColumns> readXyzColumns(InputBuffer& in, TextScanner& text,
                                           const XyzLayout& layout) {
  if (layout.names.size() <= 3) return {};
  std::vector<ColumnSurvey> surveys(layout.names.size());
  if (layout.atPoint) surveys = survey(in, text, layout);
  std::vector<Column> columns;
  std::vector<std::size_t> numberOf;
  for (std::size_t c = 0; c < layout.names.size(); ++c) {
    if (layout.axisOf[c] < 3) continue;
    columns.push_back({layout.names[c], surveys[c].type()});
    numberOf.push_back(c);
  }
  std::vector<GroupedColumns> groups = groupColumns(columns);
  for (GroupedColumns& group : groups) {
    for (std::size_t& column : group.columns) column = numberOf[column];
    if (group.array.semantic != Semantic::Colours || group.array.type != ScalarType::Int32)
      continue;
    const auto within = [&](std::uint64_t greatest) {
      return std::all_of(group.columns.begin(), group.columns.end(),
                         [&](std::size_t c) { return surveys[c].isWithin(greatest); });
    };
    if (within(UINT16_MAX)) group.array.type = ScalarType::UInt16;
    if (within(UINT8_MAX)) group.array.type = ScalarType::UInt8;
  }
  return groups;
}

}  // namespace bspc::formats
