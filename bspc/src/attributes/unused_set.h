#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bspc::attributes {

/// The numbers 0 … n − 1 that were not taken yet, with their ranks among each other.
class UnusedSet {
 public:
  explicit UnusedSet(std::size_t count)
      : words_((count + kBits - 1) / kBits, ~std::uint64_t{0}),
        sums_(words_.size() + 1),
        count_(count) {
    if (count % kBits != 0) words_.back() = (std::uint64_t{1} << (count % kBits)) - 1;
    for (std::size_t w = 0; w < words_.size(); ++w) {
      sums_[w + 1] += static_cast<std::uint32_t>(__builtin_popcountll(words_[w]));
      const std::size_t next = (w + 1) + ((w + 1) & (~(w + 1) + 1));
      if (next < sums_.size()) sums_[next] += sums_[w + 1];
    }
    while (2 * top_ < sums_.size()) top_ *= 2;
  }

  std::size_t size() const { return count_; }

  /// Takes a number that is in the set.
  void take(std::size_t number) {
    const std::size_t word = number / kBits;
    words_[word] &= ~(std::uint64_t{1} << (number % kBits));
    for (std::size_t i = word + 1; i < sums_.size(); i += i & (~i + 1)) --sums_[i];
    --count_;
  }

  /// How many of the set are below `number`.
  std::size_t rank(std::size_t number) const {
    const std::size_t word = number / kBits;
    std::size_t sum = 0;
    for (std::size_t i = word; i > 0; i &= i - 1) sum += sums_[i];
    const std::uint64_t below = (std::uint64_t{1} << (number % kBits)) - 1;
    return sum + static_cast<std::size_t>(__builtin_popcountll(words_[word] & below));
  }

  /// The one of that rank, rank < size().
  std::size_t select(std::size_t rank) const {
    std::size_t word = 0;
    for (std::size_t step = top_; step > 0; step /= 2) {
      if (word + step < sums_.size() && sums_[word + step] <= rank) {
        word += step;
        rank -= sums_[word];
      }
    }
    std::uint64_t bits = words_[word];
    for (; rank > 0; --rank) bits &= bits - 1;
    return word * kBits + static_cast<std::size_t>(__builtin_ctzll(bits));
  }

 private:
  static constexpr std::size_t kBits = 64;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> sums_;  ///< Fenwick tree over the words' counts
  std::size_t count_;
  std::size_t top_ = 1;
};

}  // namespace bspc::attributes
