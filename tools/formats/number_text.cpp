#include "formats/number_text.h"

#include <algorithm>

namespace bspc::formats {

bool spellsLessThanOne(std::string_view text) {
  const std::size_t end = std::min(text.find_first_of("eE"), text.size());
  const std::string_view mantissa = text.substr(0, end);
  const std::size_t point = std::min(mantissa.find('.'), end);
  const std::size_t leading = mantissa.find_first_of("123456789");
  if (leading == std::string_view::npos) return true;
  long long exponent = 0;
  if (end < text.size()) {
    std::string_view digits = text.substr(end + 1);
    if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    // An exponent beyond 64 bits outweighs any mantissa.
    if (result.ec == std::errc::result_out_of_range) return digits.front() == '-';
  }
  // The leading digit counts 10^(place + exponent); text is shorter than 2^62, so nothing overflows
  // once the exponent is clamped.
  exponent = std::clamp(exponent, -(1LL << 62), 1LL << 62);
  const auto place = leading < point ? static_cast<long long>(point - leading) - 1
                                     : -static_cast<long long>(leading - point);
  return place + exponent < 0;
}

}  // namespace bspc::formats
