#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "formats/input_buffer.h"
#include "formats/number_text.h"

namespace bspc::formats {

/// Cuts text into lines and tokens and knows where they stand. Lines end in LF or CR LF; a byte
/// order mark of UTF-8 at the start is passed over. Views stay valid until the next line.
class TextScanner {
 public:
  explicit TextScanner(InputBuffer& in) : in_(in) {}

  /// Moves to the next line; false at the end of the text. The input is left just behind the line.
  bool nextLine();
  /// The next token between blanks in the line; false at its end.
  bool nextToken(std::string_view& token);
  /// The next token in this line or a later one; false at the end of the text.
  bool nextTokenOfAnyLine(std::string_view& token) {
    while (!nextToken(token)) {
      if (!nextLine()) return false;
    }
    return true;
  }
  /// The next field before `separator` without the blanks around it, which may leave nothing;
  /// false at the end of the line, even behind a last separator. Separators between quotation marks
  /// belong to the field. A blank means nextToken().
  bool nextField(char separator, std::string_view& field);

  /// What is left of the line, without the blanks in front.
  std::string_view rest();
  /// Copies the line, so that it outlives what is done to the input.
  void keepLine() {
    kept_ = line_;
    line_ = kept_;
  }
  /// Goes back to the start of the line.
  void rewindLine() { cursor_ = token_ = 0; }
  /// Forgets the line from `mark` on.
  void cutComment(char mark);
  /// The same, but only if a blank is in front of the mark and it is not between quotation marks.
  void cutOuterComment(char mark);
  /// Whether the line ends in this character.
  bool endsWith(char mark) const { return !line_.empty() && line_.back() == mark; }

  /// The start of this line, to go back to in an input that can.
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t lineNumber = 0;
  };
  Place place() const { return {start_, number_}; }
  /// Reads that line once more.
  void goTo(const Place& place);

  std::uint64_t lineNumber() const { return number_; }
  /// Throws FormatError with the place of the last token or field.
  [[noreturn]] void fail(const std::string& what) const { failAt(token_, what); }
  /// Throws FormatError with the place where the line, or the text, has ended.
  [[noreturn]] void failAtEnd(const std::string& what) const { failAt(line_.size(), what); }

  /// The token as a number; `what` names it in errors: `line 17, column 5: expected a number for
  /// WHAT, found "abc"`.
  template <class T, class Describe>
  T number(std::string_view token, const Describe& what) const {
    T value{};
    const NumberStatus status = parseNumber(token, value);
    if (status != NumberStatus::Ok) {
      failNumber(status, token, std::is_integral_v<T>, what());
    }
    return value;
  }
  /// Throws the error for a token that parseNumber() does not read.
  [[noreturn]] void failNumber(NumberStatus status, std::string_view token, bool whole,
                               const std::string& what) const;

 private:
  [[noreturn]] void failAt(std::size_t column, const std::string& what) const;

  InputBuffer& in_;
  std::string_view line_;
  std::string kept_;
  std::size_t cursor_ = 0;
  std::size_t token_ = 0;
  std::uint64_t number_ = 0;
  /// Byte of the input at which the line starts.
  std::uint64_t start_ = 0;
};

}  // namespace bspc::formats
