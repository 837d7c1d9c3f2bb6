#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

#include "bspc/scalar_type.h"
#include "formats/scalar_convert.h"
#include "formats/scalar_visit.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

/// Stores the number that the token spells as `type`. Errors name it by what().
template <class Describe>
void readScalar(const TextScanner& text, std::string_view token, ScalarType type, void* to,
                const Describe& what) {
  visitScalar(type, [&](auto value) {
    const NumberStatus status = parseNumber(token, value);
    if (status != NumberStatus::Ok) {
      text.failNumber(status, token, !isFloatingPoint(type), what());
    }
    std::memcpy(to, &value, sizeof(value));
  });
}

/// Stores a coordinate that is written as `type` as `positionType`, which is commonScalarType() of
/// the three.
template <class Describe>
void readCoordinate(const TextScanner& text, std::string_view token, ScalarType type,
                    ScalarType positionType, void* to, const Describe& what) {
  if (type == positionType) return readScalar(text, token, type, to, what);
  std::uint64_t bytes = 0;
  readScalar(text, token, type, &bytes, what);
  if (convertScalars({&bytes, type, 0, false}, {to, positionType, 0}, 1) == 0) {
    text.fail("the number for " + what() + " is not exact as a float64, the type " +
              "that x, y and z have in common");
  }
}

}  // namespace bspc::formats
