#pragma once

#include <cstdint>

namespace bspc::lattice {

/// Divides by one number again and again, with multiplications: modulo 2^64 an odd number has an
/// inverse, and only its multiples times that are small.
class ExactDivisor {
 public:
  ExactDivisor() = default;  ///< by 1
  /// `divisor` > 0.
  explicit ExactDivisor(std::uint64_t divisor) : value_(divisor) {
    while (divisor % 2 == 0) {
      divisor /= 2;
      ++twos_;
    }
    inverse_ = divisor;  // right to three bits, and each step doubles them
    for (int bits = 3; bits < 64; bits *= 2) inverse_ *= 2 - divisor * inverse_;
    greatest_ = ~std::uint64_t{0} / divisor;
  }

  std::uint64_t value() const { return value_; }
  bool divides(std::uint64_t number) const {
    const bool even = (number & ((std::uint64_t{1} << twos_) - 1)) == 0;
    return even && (number >> twos_) * inverse_ <= greatest_;
  }
  /// `number` / value(), of a multiple.
  std::uint64_t quotient(std::uint64_t number) const { return (number >> twos_) * inverse_; }

 private:
  std::uint64_t value_ = 1;
  unsigned twos_ = 0;
  std::uint64_t inverse_ = 1;
  std::uint64_t greatest_ = ~std::uint64_t{0};
};

}  // namespace bspc::lattice
