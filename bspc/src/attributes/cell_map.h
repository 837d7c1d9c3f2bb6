#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/morton.h"
#include "bspc/span.h"
#include "hash_multiplier.h"

namespace bspc::attributes {

/// Cells of points whose Morton codes agree but for the lowest bits, found by what they agree in.
/// Each holds a list of numbers of points, at first none.
class CellMap {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// `shift` bits of each coordinate are left out. `curve` is mortonOrder()'s.
  CellMap(const std::vector<MortonEntry>& curve, unsigned shift) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const std::uint64_t code = curve[i].code >> (3 * shift);
      if (i == 0 || code != codes_.back()) {
        codes_.push_back(code);
        starts_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    ends_ = starts_;
    members_.resize(curve.size());
    while (std::size_t{1} << slotBits_ < 2 * codes_.size()) ++slotBits_;
    slots_.assign(std::size_t{1} << slotBits_, kNone);
    for (std::size_t c = 0; c < codes_.size(); ++c) {
      std::size_t slot = slotOf(codes_[c]);
      while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<std::uint32_t>(c);
    }
  }

  static std::uint64_t bytesFor(std::uint64_t points) { return points * 32; }

  std::size_t size() const { return codes_.size(); }
  /// Where a cell's points begin along the curve.
  std::uint32_t startOf(std::size_t cell) const { return starts_[cell]; }
  std::uint64_t code(std::size_t cell) const { return codes_[cell]; }

  /// The cell of a code; kNone if there is none.
  std::uint32_t find(std::uint64_t code) const {
    std::size_t slot = slotOf(code);
    while (slots_[slot] != kNone) {
      if (codes_[slots_[slot]] == code) return slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return kNone;
  }

  Span<const std::uint32_t> members(std::size_t cell) const {
    return {members_.data() + starts_[cell], std::size_t{ends_[cell]} - starts_[cell]};
  }
  /// Appends to a cell's list, which has room for as many as the cell has points.
  void add(std::size_t cell, std::uint32_t number) {
    if (!places_.empty()) places_[number] = ends_[cell];
    members_[ends_[cell]++] = number;
  }

  /// To be called before anything is added if things are to be removed; numbers are those of
  /// points.
  void allowRemoval() { places_.resize(members_.size()); }
  /// Takes a number out of its cell's list; the last one takes its place.
  void remove(std::size_t cell, std::uint32_t number) {
    const std::uint32_t place = places_[number];
    const std::uint32_t last = members_[--ends_[cell]];
    members_[place] = last;
    places_[last] = place;
  }

 private:
  std::size_t slotOf(std::uint64_t code) const { return hashPlace(code, multiplier_, slotBits_); }

  std::uint64_t multiplier_ = hashMultiplier();
  unsigned slotBits_ = 6;
  std::vector<std::uint64_t> codes_;
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> ends_;  ///< of the lists
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> places_;  ///< of numbers among the members
  std::vector<std::uint32_t> slots_;
};

}  // namespace bspc::attributes
