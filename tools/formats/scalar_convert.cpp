#include "formats/scalar_convert.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "formats/scalar_visit.h"

namespace bspc::formats {

namespace {

/// The same types on both sides: bytes move, no number is touched, so NaNs keep their payload.
template <std::size_t kSize>
void moveBytes(const ScalarSource& from, const ScalarTarget& to, std::size_t count) {
  const auto* source = static_cast<const std::uint8_t*>(from.data);
  auto* target = static_cast<std::uint8_t*>(to.data);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint8_t, kSize> bytes;
    std::memcpy(bytes.data(), source + i * from.stride, kSize);
    if (from.swapped) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(target + i * to.stride, bytes.data(), kSize);
  }
}

void moveScalars(const ScalarSource& from, const ScalarTarget& to, std::size_t count) {
  switch (scalarSize(from.type)) {
    case 1:
      return moveBytes<1>(from, to, count);
    case 2:
      return moveBytes<2>(from, to, count);
    case 4:
      return moveBytes<4>(from, to, count);
    default:
      return moveBytes<8>(from, to, count);
  }
}

template <class From>
From load(const std::uint8_t* at, bool swapped) {
  std::array<std::uint8_t, sizeof(From)> bytes;
  std::memcpy(bytes.data(), at, sizeof(From));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return loadScalar<From>(bytes.data());
}

template <class From>
bool isExact(From value, bool toFloatingPoint) {
  if constexpr (std::is_integral_v<From> && sizeof(From) == 8) {
    const auto bits = static_cast<std::uint64_t>(value);
    return !toFloatingPoint || isExactInDouble(value < From{0} ? 0 - bits : bits);
  } else {
    return true;
  }
}

template <class From, class To>
std::size_t convert(const ScalarSource& from, const ScalarTarget& to, std::size_t count) {
  const auto* source = static_cast<const std::uint8_t*>(from.data);
  auto* target = static_cast<std::uint8_t*>(to.data);
  for (std::size_t i = 0; i < count; ++i) {
    const From value = load<From>(source + i * from.stride, from.swapped);
    if (!isExact(value, std::is_floating_point_v<To>)) return i;
    const To converted = static_cast<To>(value);
    std::memcpy(target + i * to.stride, &converted, sizeof(To));
  }
  return count;
}

}  // namespace

bool hostIsLittleEndian() {
  const std::uint16_t one = 1;
  return loadScalar<std::uint8_t>(&one) == 1;
}

bool isExactInDouble(std::uint64_t magnitude) {
  constexpr std::uint64_t kAllBelow = std::uint64_t{1} << 53;
  while (magnitude > kAllBelow && magnitude % 2 == 0) magnitude /= 2;
  return magnitude <= kAllBelow;
}

std::size_t convertScalars(const ScalarSource& from, const ScalarTarget& to, std::size_t count) {
  if (from.type == to.type) {
    moveScalars(from, to, count);
    return count;
  }
  return visitScalar(from.type, [&](auto source) {
    return visitScalar(to.type, [&](auto target) {
      return convert<decltype(source), decltype(target)>(from, to, count);
    });
  });
}

}  // namespace bspc::formats
