#include "arrays/array_tuples.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace bspc {

void ArrayTuples::append(attributes::ArrayValues& to, const attributes::ArrayValues& from,
                         std::size_t first, std::size_t count) const {
  const auto begin = static_cast<std::ptrdiff_t>(first * tuple_);
  const auto end = begin + static_cast<std::ptrdiff_t>(count * tuple_);
  if (strings_) {
    to.strings.insert(to.strings.end(), from.strings.begin() + begin, from.strings.begin() + end);
  } else {
    to.numbers.insert(to.numbers.end(), from.numbers.begin() + begin, from.numbers.begin() + end);
  }
}

void ArrayTuples::scatter(Bytes& numbers, std::vector<std::string>& strings,
                          Span<const std::uint32_t> places) const {
  if (strings_) {
    std::vector<std::string> moved(strings.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t c = 0; c < tuple_; ++c) {
        moved[places[i] * tuple_ + c] = std::move(strings[i * tuple_ + c]);
      }
    }
    strings = std::move(moved);
    return;
  }
  Bytes moved(numbers.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::memcpy(moved.data() + places[i] * tuple_, numbers.data() + i * tuple_, tuple_);
  }
  numbers = std::move(moved);
}

void ArrayTuples::keep(Bytes& numbers, std::vector<std::string>& strings,
                       const std::vector<std::size_t>& kept) const {
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == i) continue;
    if (strings_) {
      for (std::size_t c = 0; c < tuple_; ++c) {
        strings[i * tuple_ + c] = std::move(strings[kept[i] * tuple_ + c]);
      }
    } else {
      std::memcpy(numbers.data() + i * tuple_, numbers.data() + kept[i] * tuple_, tuple_);
    }
  }
  if (strings_) {
    strings.resize(kept.size() * tuple_);
  } else {
    numbers.resize(kept.size() * tuple_);
  }
}

}  // namespace bspc
