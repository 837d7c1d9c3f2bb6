#include <string>
#include <vector>

#include "formats/array_tuples.h"
#include "formats/ply_body.h"
#include "formats/scalar_text.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Tokens are read without regard to line ends: elements that some writer wrapped are read, and a
/// number too many or too few shows at the end of the data.
class AsciiBody : public PlyBody {
 public:
  AsciiBody(TextScanner& text, const PlyHeader& header)
      : text_(text),
        header_(header),
        axes_(plyAxes(header)),
        targets_(targetsOf(header.arrays, axes_.size())) {}

  void skip(const PlyElement& element) override {
    element_ = &element;
    // Without properties there is nothing to read, however many elements are claimed.
    if (element.properties.empty()) return;
    for (index_ = 0; index_ < element.count; ++index_) {
      for (const PlyProperty& property : element.properties) skipProperty(property);
    }
  }

  void readLists(const PlyElement& element, std::size_t property, Cells& cells) override {
    element_ = &element;
    for (index_ = 0; index_ < element.count; ++index_) {
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (p != property) {
          skipProperty(element.properties[p]);
          continue;
        }
        cell_.clear();
        readItems(element.properties[p], [&](const std::uint64_t* bytes, ScalarType type) {
          visitScalar(type, [&](auto zero) {
            const auto number = static_cast<double>(loadScalar<decltype(zero)>(bytes));
            cell_.push_back(plyVertex(header_, number, element, index_));
          });
        });
        cells.add(cell_);
      }
    }
  }

  void readVertices(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                    Span<ArrayValues> values) override {
    const std::size_t size = scalarSize(header_.positionType);
    element_ = &header_.vertices();
    for (std::size_t i = 0; i < count; ++i) {
      index_ = first + i;
      appendTuple(values);
      for (std::size_t p = 0; p < element_->properties.size(); ++p) {
        const PlyProperty& property = element_->properties[p];
        if (axes_[p] < 3) {
          readCoordinate(text_, nextToken(), property.type, header_.positionType,
                         positions + (3 * i + axes_[p]) * size,
                         [&property] { return describe(property); });
        } else if (!values.empty() && targets_[p].array != ColumnTarget::kNone) {
          readNumber(property.type, property, targets_[p].at(values));
        } else {
          skipProperty(property);
        }
      }
    }
  }

  void requireEnd() override {
    std::string_view token;
    if (text_.nextTokenOfAnyLine(token)) {
      text_.fail("trailing data after the last element: " + quoted(token));
    }
  }

 private:
  void skipProperty(const PlyProperty& property) {
    std::uint64_t bytes = 0;
    if (!property.isList) return readNumber(property.type, property, &bytes);
    readItems(property, [](const std::uint64_t* /*bytes*/, ScalarType /*type*/) {});
  }

  /// Calls visit() with each number of a list.
  template <class Visit>
  void readItems(const PlyProperty& property, Visit visit) {
    std::uint64_t bytes = 0;
    readNumber(property.countType, property, &bytes);
    std::uint64_t count = 0;
    visitScalar(property.countType, [&](auto zero) {
      const auto value = loadScalar<decltype(zero)>(&bytes);
      if (value < zero) text_.fail("a negative number of items for " + describe(property));
      count = static_cast<std::uint64_t>(value);
    });
    for (std::uint64_t i = 0; i < count; ++i) {
      readNumber(property.type, property, &bytes);
      visit(&bytes, property.type);
    }
  }

  /// Stores the next number as `type` at `to`.
  void readNumber(ScalarType type, const PlyProperty& property, void* to) {
    readScalar(text_, nextToken(), type, to, [&property] { return describe(property); });
  }

  std::string_view nextToken() {
    std::string_view token;
    if (!text_.nextTokenOfAnyLine(token)) {
      text_.failAtEnd("the file ends inside " + plyPlace(*element_, index_));
    }
    return token;
  }

  static std::string describe(const PlyProperty& property) {
    return "property " + quoted(property.name) + " (" + scalarName(property.type) + ")";
  }

  TextScanner& text_;
  const PlyHeader& header_;
  std::vector<std::size_t> axes_;
  std::vector<ColumnTarget> targets_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
  std::vector<std::uint32_t> cell_;
};

}  // namespace

std::unique_ptr<PlyBody> asciiPlyBody(TextScanner& text, const PlyHeader& header) {
  return std::make_unique<AsciiBody>(text, header);
}

}  // namespace bspc::formats
