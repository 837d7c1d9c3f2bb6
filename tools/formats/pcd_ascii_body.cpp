#include <string_view>

#include "formats/pcd_body.h"
#include "formats/scalar_text.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// A point a line; empty lines count for nothing.
class AsciiBody : public PcdBody {
 public:
  AsciiBody(TextScanner& text, const PcdHeader& header) : text_(text), header_(header) {}

  void readPoints(std::uint64_t first, std::size_t count, std::uint8_t* positions) override {
    const std::size_t pointBytes = 3 * scalarSize(header_.positionType);
    for (std::size_t i = 0; i < count; ++i) {
      if (!nextContent()) {
        text_.failAtEnd("the file ends before " + pcdPlace(header_, first + i));
      }
      readPoint(first + i, positions + i * pointBytes);
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

  void readPoint(std::uint64_t index, std::uint8_t* position) {
    std::string_view token;
    std::uint64_t number = 0;
    for (; text_.nextToken(token); ++number) {
      if (number == header_.pointNumbers) failCount("more", index);
      for (std::size_t k = 0; k < 3; ++k) {
        const PcdField& field = header_.axis(k);
        if (field.numberOffset != number) continue;
        readCoordinate(text_, token, field.type, header_.positionType,
                       position + k * scalarSize(header_.positionType), [&] {
                         return "field " + quoted(field.name) + " (" + scalarName(field.type) +
                                ") of " + pcdPlace(header_, index);
                       });
      }
    }
    if (number < header_.pointNumbers) failCount(grouped(number), index);
  }

  [[noreturn]] void failCount(const std::string& found, std::uint64_t index) const {
    text_.fail("expected " + counted(header_.pointNumbers, "number", "numbers") + " of " +
               pcdPlace(header_, index) + ", found " + found);
  }

  TextScanner& text_;
  const PcdHeader& header_;
};

}  // namespace

std::unique_ptr<PcdBody> asciiPcdBody(TextScanner& text, const PcdHeader& header) {
  return std::make_unique<AsciiBody>(text, header);
}

}  // namespace bspc::formats
