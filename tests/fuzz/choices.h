#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "bspc/span.h"

namespace bspc::fuzz {

/// Choices taken from an input.
class Choices {
 public:
  explicit Choices(ByteView input) : data_(input.data()), left_(input.size()) {}

  /// 0 … count − 1; 0 once the input is used up.
  std::uint64_t below(std::uint64_t count) {
    std::uint64_t value = 0;
    for (std::uint64_t range = 1; range < count && left_ > 0; --left_) {
      value = value << 8 | *data_++;
      range = range >> 56 != 0 ? ~std::uint64_t{0} : range << 8;
    }
    return count == 0 ? 0 : value % count;
  }
  bool yes() { return below(2) == 1; }
  /// So many bits.
  std::uint64_t bits(unsigned count) {
    std::uint64_t value = 0;
    for (unsigned taken = 0; taken < count && left_ > 0; taken += 8, --left_) {
      value = value << 8 | *data_++;
    }
    return count == 64 ? value : value & ((std::uint64_t{1} << count) - 1);
  }
  std::size_t left() const { return left_; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// Random choices, the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t below(std::uint64_t count) { return count == 0 ? 0 : engine_() % count; }
  bool oneIn(std::uint64_t count) { return below(count) == 0; }
  std::uint64_t bits() { return engine_(); }
  /// A number near `value`, or one of those at which widths and signs end.
  std::uint64_t number(std::uint64_t value);

 private:
  std::mt19937_64 engine_;
};

}  // namespace bspc::fuzz
