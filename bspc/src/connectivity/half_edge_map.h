#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hash_multiplier.h"

namespace bspc::connectivity {

/// What stands at each directed edge of a mesh: a hash table with open addressing that grows as
/// half-edges are put in.
class HalfEdgeMap {
 public:
  static constexpr std::uint32_t kAbsent = 0xFFFFFFFF;

  HalfEdgeMap() : entries_(std::size_t{1} << kFirstBits) {}

  /// The value put in for `from` → `to`, or kAbsent.
  std::uint32_t find(std::uint32_t from, std::uint32_t to) const {
    return entries_[slot(from, to)].value;
  }
  bool contains(std::uint32_t from, std::uint32_t to) const { return find(from, to) != kAbsent; }

  /// Replaces an earlier value; `value` must not be kAbsent.
  void put(std::uint32_t from, std::uint32_t to, std::uint32_t value) {
    Entry& entry = entries_[slot(from, to)];
    const bool fresh = entry.value == kAbsent;
    entry = {from, to, value};
    if (fresh && 3 * ++used_ > 2 * entries_.size()) grow();
  }

  std::size_t bytes() const { return entries_.size() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t value = kAbsent;
  };
  static constexpr unsigned kFirstBits = 6;

  std::size_t slot(std::uint32_t from, std::uint32_t to) const {
    const std::uint64_t key = (std::uint64_t{from} << 32) | to;
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = hashPlace(key, multiplier_, bits_);
    while (entries_[at].value != kAbsent && (entries_[at].from != from || entries_[at].to != to)) {
      at = (at + 1) & mask;
    }
    return at;
  }

  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    ++bits_;
    old.swap(entries_);
    for (const Entry& entry : old) {
      if (entry.value != kAbsent) entries_[slot(entry.from, entry.to)] = entry;
    }
  }

  std::uint64_t multiplier_ = hashMultiplier();
  unsigned bits_ = kFirstBits;
  std::vector<Entry> entries_;
  std::size_t used_ = 0;
};

}  // namespace bspc::connectivity
