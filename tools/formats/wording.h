#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace bspc::formats {

/// "1,234,567".
std::string grouped(std::uint64_t value);

/// "1 face" or "5,660 faces".
std::string counted(std::uint64_t count, const std::string& one, const std::string& many);

/// A piece of a file in quotation marks, cut short and without control characters, so that no file
/// can bring escape sequences or pages of text into a message.
std::string quoted(std::string_view text);

/// The text if it is valid UTF-8, else with each of its bytes as the character of Latin-1.
std::string utf8(std::string_view text);

/// The text with A to Z made small, whatever the locale.
std::string lowerCase(std::string_view text);

}  // namespace bspc::formats
