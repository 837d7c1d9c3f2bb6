#include "attributes/morton.h"

#include <algorithm>
#include <array>

#include "entropy/symbol_coder.h"

namespace bspc::attributes {

unsigned coordinateBits(Span<const GridPoint> points) {
  std::uint32_t any = 0;
  for (const GridPoint& p : points) any |= p[0] | p[1] | p[2];
  return entropy::bitLength(any);
}

namespace {

/// Sorts by the code, stable, a byte pass at a time; bytes that are equal in all codes cost
/// nothing.
void radixSort(std::vector<MortonEntry>& entries) {
  constexpr unsigned kDigits = 256;
  std::uint64_t differing = 0;
  for (const MortonEntry& e : entries) differing |= e.code ^ entries[0].code;
  std::vector<MortonEntry> other(entries.size());
  for (unsigned shift = 0; shift < 64; shift += 8) {
    if (((differing >> shift) & 0xFF) == 0) continue;
    std::array<std::size_t, kDigits> start{};
    for (const MortonEntry& e : entries) ++start[(e.code >> shift) & 0xFF];
    std::size_t sum = 0;
    for (std::size_t& s : start) {
      const std::size_t count = s;
      s = sum;
      sum += count;
    }
    for (const MortonEntry& e : entries) other[start[(e.code >> shift) & 0xFF]++] = e;
    entries.swap(other);
  }
}

}  // namespace

std::vector<MortonEntry> mortonOrder(Span<const GridPoint> points, unsigned bits) {
  const unsigned cut = bits > kMortonBits ? bits - kMortonBits : 0;
  std::vector<MortonEntry> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const GridPoint& p = points[i];
    entries[i].code = mortonCode(p[0] >> cut, p[1] >> cut, p[2] >> cut);
    entries[i].index = static_cast<std::uint32_t>(i);
  }
  radixSort(entries);
  return entries;
}

unsigned cellShift(const std::vector<MortonEntry>& order, unsigned mean) {
  constexpr unsigned kMaxShift = kMortonBits - 1;
  // ends[s]: how many neighbours along the curve are in different cells of shift s, but in one of
  // shift s + 1.
  std::array<std::size_t, kMortonBits + 1> ends{};
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::uint64_t differing = order[i].code ^ order[i - 1].code;
    if (differing != 0) ++ends[(entropy::bitLength(differing) - 1) / 3];
  }
  std::size_t cells = 1;
  for (const std::size_t e : ends) cells += e;
  for (unsigned shift = 0; shift < kMaxShift; ++shift) {
    if (order.size() / mean >= cells) return shift;
    cells -= ends[shift];
  }
  return kMaxShift;
}

}  // namespace bspc::attributes
