#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace bspc::formats {

enum class NumberStatus : std::uint8_t { Ok, Malformed, OutOfRange };

/// Whether the decimal number that `text` spells, if it is one, is below 1 in magnitude.
bool spellsLessThanOne(std::string_view text);

/// Reads the number that the whole of `text` spells, whatever the locale; a leading + and, for
/// floating point, "nan" and "inf" are allowed. Numbers too small for T become zero.
template <class T>
NumberStatus parseNumber(std::string_view text, T& value) {
  const char* first = text.data();
  const char* const last = first + text.size();
  // std::from_chars knows no leading +.
  if (first != last && *first == '+') {
    ++first;
    if (first != last && *first == '-') return NumberStatus::Malformed;
  }
  const std::from_chars_result result = std::from_chars(first, last, value);
  if (result.ec == std::errc::invalid_argument || result.ptr != last) {
    return NumberStatus::Malformed;
  }
  if (result.ec == std::errc()) return NumberStatus::Ok;
  if constexpr (std::is_floating_point_v<T>) {
    if (spellsLessThanOne(text)) {
      value = *first == '-' ? -T(0) : T(0);
      return NumberStatus::Ok;
    }
  }
  return NumberStatus::OutOfRange;
}

/// Appends the shortest text that parseNumber() restores to the same number, the sign of zero too.
template <class T>
void appendNumber(std::string& text, T value) {
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  text.append(buffer.data(), end);
}

}  // namespace bspc::formats
