#include "formats/xyz_reader.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/position_text.h"
#include "formats/text_scanner.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// The name without quotation marks around it.
std::string_view unquoted(std::string_view name) {
  const bool isQuoted = name.size() >= 2 && name.front() == '"' && name.back() == '"';
  return isQuoted ? name.substr(1, name.size() - 2) : name;
}

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

class XyzStream : public PointStream {
 public:
  explicit XyzStream(InputBuffer in) : in_(std::move(in)), text_(in_) {
    info_.type = kTextType;
    atPoint_ = nextContent();
    if (!atPoint_) return;
    chooseSeparator();
    readLayout();
    if (!names_.empty()) atPoint_ = nextContent();
  }

  std::size_t read(std::uint8_t* positions, std::size_t count) override {
    std::size_t done = 0;
    for (; done < count && atPoint_; ++done) {
      storePosition(positions, done, readPoint());
      atPoint_ = nextContent();
    }
    // Columns without points hold nothing.
    if (done > 0 && info_.otherContent.empty()) nameOtherContent();
    return done;
  }

 private:
  /// Moves to the next line that has something in it beside a comment.
  bool nextContent() {
    while (text_.nextLine()) {
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
      separator_ = separator;
      break;
    }
    text_.rewindLine();
  }

  /// Finds the columns from the first line: names if its first field is no number.
  void readLayout() {
    std::string_view field;
    double number = 0;
    text_.nextField(separator_, field);
    const bool hasNames = parseNumber(field, number) == NumberStatus::Malformed;
    text_.rewindLine();
    for (columns_ = 0; text_.nextField(separator_, field); ++columns_) {
      if (hasNames) takeName(field);
    }
    text_.rewindLine();
    if (!hasNames) {
      axes_ = {0, 1, 2};
    } else if (std::count(found_.begin(), found_.end(), true) < 3) {
      failWithoutAxes();
    }
    axisOf_.assign(std::max<std::size_t>(columns_, 3), 3);
    for (std::size_t k = 0; k < 3; ++k) axisOf_[axes_[k]] = k;
  }

  void takeName(std::string_view field) {
    // CloudCompare writes "//X Y Z".
    if (columns_ == 0 && field.substr(0, 2) == "//") field.remove_prefix(2);
    const std::string_view name = unquoted(field);
    const std::size_t axis = axisFromName(name);
    if (axis < 3) {
      if (found_[axis]) text_.fail("a second column " + quoted(name));
      found_[axis] = true;
      axes_[axis] = columns_;
    }
    names_.emplace_back(name);
  }

  [[noreturn]] void failWithoutAxes() const {
    std::string names;
    for (std::size_t i = 0; i < names_.size() && i < 8; ++i) {
      names += (i > 0 ? ", " : "") + quoted(names_[i]);
    }
    text_.fail("expected three numbers, or names of columns with x, y and z among them, found " +
               names);
  }

  std::array<double, 3> readPoint() {
    std::array<double, 3> position{};
    std::string_view field;
    std::size_t column = 0;
    for (; text_.nextField(separator_, field); ++column) {
      if (column >= axisOf_.size()) {
        text_.fail("expected " + counted(axisOf_.size(), "column", "columns") +
                   " as in the first line, found more");
      }
      const std::size_t axis = axisOf_[column];
      if (axis == 3) continue;
      position[axis] = text_.number<double>(field, [axis] { return std::string(1, "xyz"[axis]); });
    }
    // An empty last column leaves nothing behind its separator.
    const bool endsEmpty = separator_ != ' ' && text_.endsWith(separator_);
    if (endsEmpty && column < axisOf_.size() && axisOf_[column] == 3) ++column;
    if (column < axisOf_.size()) {
      text_.failAtEnd("expected " + counted(axisOf_.size(), "column", "columns") + ", found " +
                      grouped(column));
    }
    return position;
  }

  void nameOtherContent() {
    for (std::size_t column = 0; column < axisOf_.size(); ++column) {
      if (axisOf_[column] < 3) continue;
      const bool isNamed = column < names_.size() && !names_[column].empty();
      info_.otherContent.push_back("column " +
                                   (isNamed ? quoted(names_[column]) : grouped(column + 1)));
    }
  }

  InputBuffer in_;
  TextScanner text_;
  /// Whether the line is a point that has not been read yet.
  bool atPoint_ = false;
  char separator_ = ' ';
  std::size_t columns_ = 0;
  std::vector<std::string> names_;
  std::array<bool, 3> found_{};
  std::array<std::size_t, 3> axes_{};
  /// Which coordinate each column is, 3 for none.
  std::vector<std::size_t> axisOf_;
};

}  // namespace

std::unique_ptr<PointStream> openXyz(InputBuffer in) {
  return std::make_unique<XyzStream>(std::move(in));
}

}  // namespace bspc::formats
