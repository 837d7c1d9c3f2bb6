#include "cli/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

namespace bspc::cli {

std::string withCommas(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, ",");
  }
  return text;
}

std::string fixed(double value, int digits) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", digits, value);
  return buffer.data();
}

std::string shortest(double value) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string coordinateText(const Grid& grid, double value) {
  if (grid.scalarType != ScalarType::Float32) return shortest(value);
  std::array<char, 64> buffer{};
  const auto single = static_cast<float>(value);
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), single).ptr;
  return {buffer.data(), end};
}

std::string rounded(double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

std::string oneLine(const std::string& text, std::size_t longest) {
  const bool isCut = text.size() > longest;
  std::string line = text.substr(0, longest);
  // No half of a character at the end: its later bytes are 10xxxxxx.
  while (isCut && !line.empty() &&
         (static_cast<unsigned char>(text[line.size()]) & 0xC0U) == 0x80U) {
    line.pop_back();
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto byte = static_cast<unsigned char>(line[i]);
    const auto next = static_cast<unsigned char>(i + 1 < line.size() ? line[i + 1] : 0);
    // U+0080 to U+009F are control characters too.
    const bool isLong = byte == 0xC2 && next >= 0x80 && next <= 0x9F;
    if (byte < ' ' || byte == 127 || isLong) line[i] = ' ';
    if (isLong) line[i + 1] = ' ';
  }
  return line + (isCut ? "..." : "");
}

std::string errorText(bool exact, const std::array<double, 3>& maxError) {
  if (exact) return "exact";
  std::array<char, 64> buffer{};
  const double greatest = *std::max_element(maxError.begin(), maxError.end());
  std::snprintf(buffer.data(), buffer.size(), "greatest error %.3g", greatest);
  return buffer.data();
}

std::string gridText(const Grid& grid) {
  if (grid.form == Grid::Form::FloatBits) {
    return std::string("every bit of ") + scalarName(grid.scalarType);
  }
  const bool shared = grid.step(0) == grid.step(1) && grid.step(0) == grid.step(2);
  std::string text = "step " + shortest(grid.step(0));
  if (!shared) text += ", " + shortest(grid.step(1)) + ", " + shortest(grid.step(2));
  text += " from (";
  for (int k = 0; k < 3; ++k) {
    text += shortest(grid.coordinate(k, 0)) + (k < 2 ? ", " : ")");
  }
  return text + ", " + scalarName(grid.scalarType);
}

}  // namespace bspc::cli
