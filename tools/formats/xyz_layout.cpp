#include "formats/xyz_layout.h"

#include <algorithm>
#include <set>
#include <utility>

#include "formats/array_columns.h"
#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Which coordinate a column of this name is, 3 for none. ParaView calls them Points:0 to Points:2.
std::size_t axisFromName(std::string_view name) {
  const std::string small = lowerCase(name);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string digit = std::to_string(k);
    if (small == std::string(1, "xyz"[k]) || small == "points:" + digit ||
        small == "points_" + digit) {
      return k;
    }
  }
  return 3;
}

class LayoutReader {
 public:
  explicit LayoutReader(TextScanner& text) : text_(text) {}

  XyzLayout read() {
    if (!nextContent()) return std::move(layout_);
    chooseSeparator();
    std::string_view field;
    double number = 0;
    text_.nextField(layout_.separator, field);
    const bool hasNames = parseNumber(field, number) == NumberStatus::Malformed;
    text_.rewindLine();
    if (hasNames) {
      takeNames();
      if (std::count(found_.begin(), found_.end(), true) < 3) failWithoutAxes();
      layout_.atPoint = nextXyzContent(text_, layout_.separator);
    } else {
      std::size_t columns = 0;
      while (text_.nextField(layout_.separator, field)) ++columns;
      text_.rewindLine();
      useComment(columns);
      layout_.atPoint = true;
    }
    nameNameless();
    return std::move(layout_);
  }

 private:
  /// Comments in front of the points may be names.
  bool nextContent() {
    while (text_.nextLine()) {
      const std::string_view line = text_.rest();
      if (line.substr(0, 1) == "#") comment_ = line.substr(1);
      text_.cutComment('#');
      if (text_.rest().empty()) continue;
      text_.rewindLine();
      return true;
    }
    return false;
  }

  void chooseSeparator() {
    const std::string_view line = text_.rest();
    for (const char separator : {';', ','}) {
      if (line.find(separator) == std::string_view::npos) continue;
      layout_.separator = separator;
      break;
    }
    text_.rewindLine();
  }

  void takeNames() {
    std::string_view field;
    while (text_.nextField(layout_.separator, field)) {
      // CloudCompare writes "//X Y Z".
      if (layout_.names.empty() && field.substr(0, 2) == "//") field.remove_prefix(2);
      if (!takeName(unquotedField(field))) text_.fail("a second column " + quoted(field));
    }
  }

  bool takeName(const std::string& name) {
    const std::size_t axis = axisFromName(name);
    if (axis < 3) {
      if (found_[axis]) return false;
      found_[axis] = true;
    } else if (!name.empty() && !seen_.insert(name).second) {
      return false;
    }
    layout_.axisOf.push_back(axis);
    layout_.names.push_back(utf8(name));
    return true;
  }

  /// The last comment in front of points without names, if it has as many words as they have
  /// columns and x, y and z are among them; that is what writers of this library leave.
  void useComment(std::size_t columns) {
    bool isGood = true;
    std::size_t at = 0;
    while (isGood && (at = comment_.find_first_not_of(" \t\r", at)) != std::string::npos) {
      const std::size_t end = std::min(comment_.find_first_of(" \t\r", at), comment_.size());
      isGood = takeName(comment_.substr(at, end - at));
      at = end;
    }
    isGood = isGood && std::count(found_.begin(), found_.end(), true) == 3 &&
             layout_.names.size() == columns;
    if (isGood) return;
    layout_.names.clear();
    layout_.axisOf.assign(std::max<std::size_t>(columns, 3), 3);
    for (std::size_t k = 0; k < 3; ++k) layout_.axisOf[k] = k;
  }

  /// A column among named ones is known by its number, counted from 1.
  void nameNameless() {
    for (std::size_t c = 0; c < layout_.names.size(); ++c) {
      std::string& name = layout_.names[c];
      if (!name.empty()) continue;
      name = uniqueName("column " + std::to_string(c + 1), seen_);
      seen_.insert(name);
    }
  }

  [[noreturn]] void failWithoutAxes() const {
    std::string names;
    for (std::size_t i = 0; i < layout_.names.size() && i < 8; ++i) {
      names += (i > 0 ? ", " : "") + quoted(layout_.names[i]);
    }
    text_.fail("expected three numbers, or names of columns with x, y and z among them, found " +
               names);
  }

  TextScanner& text_;
  XyzLayout layout_;
  std::string comment_;
  std::array<bool, 3> found_{};
  std::set<std::string> seen_;
};

}  // namespace

XyzLayout readXyzLayout(TextScanner& text) { return LayoutReader(text).read(); }

bool nextXyzContent(TextScanner& text, char separator) {
  while (text.nextLine()) {
    if (separator == ' ') {
      text.cutComment('#');
    } else {
      text.cutOuterComment('#');
    }
    if (text.rest().empty()) continue;
    text.rewindLine();
    return true;
  }
  return false;
}

std::string unquotedField(std::string_view field) {
  const bool isQuoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  if (!isQuoted) return std::string(field);
  std::string text;
  for (std::size_t i = 1; i + 1 < field.size(); ++i) {
    text += field[i];
    if (field[i] == '"' && field[i + 1] == '"' && i + 2 < field.size()) ++i;
  }
  return text;
}

}  // namespace bspc::formats
