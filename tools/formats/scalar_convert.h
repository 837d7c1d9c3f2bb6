#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/scalar_type.h"

namespace bspc::formats {

bool hostIsLittleEndian();

/// Whether a double holds this whole number (or its negative) exactly.
bool isExactInDouble(std::uint64_t magnitude);

/// Numbers of one type, `stride` bytes apart, in the byte order of this machine or the other one.
struct ScalarSource {
  const void* data = nullptr;
  ScalarType type = ScalarType::Float32;
  std::size_t stride = 0;
  bool swapped = false;
};

/// Where numbers go: of one type, `stride` bytes apart, in the byte order of this machine.
struct ScalarTarget {
  void* data = nullptr;
  ScalarType type = ScalarType::Float32;
  std::size_t stride = 0;
};

/// Converts `count` numbers. `to.type` is the type of `from` or one that holds its numbers exactly,
/// but for 64-bit integers that become doubles: returns how many came before the first that a
/// double does not hold, `count` if all do.
std::size_t convertScalars(const ScalarSource& from, const ScalarTarget& to, std::size_t count);

}  // namespace bspc::formats
