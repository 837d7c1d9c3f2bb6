#include "formats/text_scanner.h"

#include <algorithm>
#include <cstring>

#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Characters of the quotation that the text starts with, in which two marks stand for one; 0 if it
/// starts with none or the mark has no counterpart.
std::size_t quotedSize(std::string_view text) {
  if (text.substr(0, 1) != "\"") return 0;
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (text[at] != '"') continue;
    if (at + 1 == text.size() || text[at + 1] != '"') return at + 1;
    ++at;
  }
  return 0;
}

}  // namespace

bool TextScanner::nextLine() {
  std::size_t searched = 0;
  const char* end = nullptr;
  for (;;) {
    const std::size_t available = in_.available();
    if (available > searched) {
      end =
          static_cast<const char*>(std::memchr(in_.data() + searched, '\n', available - searched));
    }
    searched = available;
    if (end != nullptr || !in_.fill()) break;
  }
  if (end == nullptr && searched == 0) return false;
  const std::size_t size = end != nullptr ? static_cast<std::size_t>(end - in_.data()) : searched;
  line_ = std::string_view(in_.data(), size);
  start_ = in_.offset();
  in_.consume(end != nullptr ? size + 1 : size);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  if (number_ == 0 && line_.substr(0, 3) == "\xEF\xBB\xBF") line_.remove_prefix(3);
  ++number_;
  cursor_ = token_ = 0;
  return true;
}

bool TextScanner::nextToken(std::string_view& token) {
  const std::size_t size = line_.size();
  while (cursor_ < size && isBlank(line_[cursor_])) ++cursor_;
  token_ = cursor_;
  while (cursor_ < size && !isBlank(line_[cursor_])) ++cursor_;
  token = line_.substr(token_, cursor_ - token_);
  return !token.empty();
}

bool TextScanner::nextField(char separator, std::string_view& field) {
  if (separator == ' ') return nextToken(field);
  field = rest();
  token_ = cursor_;
  if (field.empty()) return false;
  const std::size_t size = std::min(field.find(separator, quotedSize(field)), field.size());
  cursor_ = std::min(cursor_ + size + 1, line_.size());
  field = field.substr(0, size);
  while (!field.empty() && isBlank(field.back())) field.remove_suffix(1);
  return true;
}

std::string_view TextScanner::rest() {
  while (cursor_ < line_.size() && isBlank(line_[cursor_])) ++cursor_;
  return line_.substr(cursor_);
}

void TextScanner::cutComment(char mark) {
  line_ = line_.substr(0, std::min(line_.find(mark), line_.size()));
}

void TextScanner::cutOuterComment(char mark) {
  bool isQuoted = false;
  for (std::size_t at = 0; at < line_.size(); ++at) {
    if (line_[at] == '"') isQuoted = !isQuoted;
    if (line_[at] != mark || isQuoted || (at > 0 && !isBlank(line_[at - 1]))) continue;
    line_ = line_.substr(0, at);
    return;
  }
}

void TextScanner::goTo(const Place& place) {
  in_.seek(place.offset);
  number_ = place.lineNumber - 1;
  nextLine();
}

void TextScanner::failAt(std::size_t column, const std::string& what) const {
  throw FormatError("line " + grouped(std::max<std::uint64_t>(number_, 1)) + ", column " +
                    grouped(column + 1) + ": " + what);
}

void TextScanner::failNumber(NumberStatus status, std::string_view token, bool whole,
                             const std::string& what) const {
  const std::string kind = whole ? "a whole number" : "a number";
  if (status == NumberStatus::OutOfRange) {
    fail("the number " + quoted(token) + " for " + what + " is out of range");
  }
  fail("expected " + kind + " for " + what + ", found " +
       (token.empty() ? "nothing" : quoted(token)));
}

}  // namespace bspc::formats
