#include "formats/xyz_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/array_tuples.h"
#include "formats/position_text.h"
#include "formats/scalar_visit.h"
#include "formats/text_scanner.h"
#include "formats/wording.h"
#include "formats/xyz_columns.h"
#include "formats/xyz_layout.h"

namespace bspc::formats {

namespace {

class XyzStream : public PointStream {
 public:
  explicit XyzStream(InputBuffer in) : in_(std::move(in)), text_(in_) {
    info_.type = kTextType;
    layout_ = readXyzLayout(text_);
    const std::vector<GroupedColumns> groups = readXyzColumns(in_, text_, layout_);
    info_.arrays = arraysOf(groups);
    targets_ = targetsOf(groups, layout_.axisOf.size());
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    std::size_t done = 0;
    for (; done < count && layout_.atPoint; ++done) {
      storePosition(positions, done, readPoint(values));
      layout_.atPoint = nextXyzContent(text_, layout_.separator);
    }
    // Columns without points hold nothing.
    if (done > 0 && info_.otherContent.empty()) nameOtherContent();
    return done;
  }

 private:
  std::array<double, 3> readPoint(Span<ArrayValues> values) {
    const std::vector<std::size_t>& axisOf = layout_.axisOf;
    std::array<double, 3> position{};
    std::string_view field;
    std::size_t column = 0;
    appendTuple(values);
    for (; text_.nextField(layout_.separator, field); ++column) {
      if (column >= axisOf.size()) {
        text_.fail("expected " + counted(axisOf.size(), "column", "columns") +
                   " as in the first line, found more");
      }
      const std::size_t axis = axisOf[column];
      if (axis == 3) {
        store(column, field, values);
      } else {
        position[axis] =
            text_.number<double>(field, [axis] { return std::string(1, "xyz"[axis]); });
      }
    }
    // An empty last column leaves nothing behind its separator.
    const bool endsEmpty = layout_.separator != ' ' && text_.endsWith(layout_.separator);
    if (endsEmpty && column < axisOf.size() && axisOf[column] == 3) store(column++, "", values);
    if (column < axisOf.size()) {
      text_.failAtEnd("expected " + counted(axisOf.size(), "column", "columns") + ", found " +
                      grouped(column));
    }
    return position;
  }

  /// Puts the field into the last tuple of its array.
  void store(std::size_t column, std::string_view field, Span<ArrayValues> values) {
    const ColumnTarget& target = targets_[column];
    if (values.empty() || target.array == ColumnTarget::kNone) return;
    ArrayValues& array = values[target.array];
    if (array.type == ScalarType::String) {
      array.strings.back() = utf8(unquotedField(field));
      return;
    }
    visitScalar(array.type, [&](auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        if (field.empty()) field = "nan";
      }
      if (parseNumber(field, value) != NumberStatus::Ok) failType(column, field);
      std::memcpy(target.at(values), &value, sizeof(value));
    });
  }

  /// Only the start of a pipe was looked at for types.
  [[noreturn]] void failType(std::size_t column, std::string_view field) const {
    text_.fail("the column " + quoted(layout_.names[column]) + " has " +
               scalarName(info_.arrays[targets_[column].array].type) +
               " numbers at the start of the text, found " +
               (field.empty() ? "nothing" : quoted(field)) +
               "; of a file that is no pipe all lines are looked at before");
  }

  void nameOtherContent() {
    if (!layout_.names.empty()) return;
    for (std::size_t column = 3; column < layout_.axisOf.size(); ++column) {
      info_.otherContent.push_back(
          {"column " + grouped(column + 1) + " without a name", OtherContent::Kind::Rest});
    }
  }

  InputBuffer in_;
  TextScanner text_;
  XyzLayout layout_;
  std::vector<ColumnTarget> targets_;
};

}  // namespace

std::unique_ptr<PointStream> openXyz(InputBuffer in) {
  return std::make_unique<XyzStream>(std::move(in));
}

}  // namespace bspc::formats
